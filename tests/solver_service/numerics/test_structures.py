"""Weirs, culverts and pumps as numbers: what is accepted, refused and snapped."""

import dataclasses
import math

import numpy as np
import pytest

from solver_service.errors import ModelError
from solver_service.numerics.structures import Culvert, Pump, Weir

SHAPE = (20, 30)

WEIR = Weir("wall", ((2.0, 3.5), (20.0, 3.5)), (1.0, 4.0))
CULVERT = Culvert("road", ((3, 4), (3, 5)), ((8, 4),), 1.0, 0.5, 2.0, 1.0, 20.0)
PUMP = Pump("station", ((3, 4),), ((9, 9),), (0.0, 2.0), (1.0, 3.0), "level", 1.5, 0.5)


def test_a_crest_is_interpolated_between_its_vertices():
    levels, shares = WEIR.face_levels(WEIR.snapped(SHAPE, 1.0).faces)
    assert np.all(np.diff(levels) > 0.0)
    assert levels[0] == pytest.approx(1.0 + 3.0 * 1.0 / 18.0), "the first face lies a cell on"
    assert shares.tolist() == [1.0] * len(levels)


def test_the_shares_of_a_staircase_add_up_to_the_length_of_its_line():
    vertices = ((2.5, 2.5), (14.5, 11.5))
    weir = Weir("wall", vertices, 1.0)
    _, shares = weir.face_levels(weir.snapped(SHAPE, 1.0).faces)
    assert len(shares) == 12 + 9
    assert shares.sum() == pytest.approx(math.hypot(12.0, 9.0))


def test_structures_show_the_cells_and_faces_they_take():
    assert CULVERT.snapped(SHAPE, 1.0).cells.tolist() == [[3, 4], [3, 5], [8, 4]]
    assert dataclasses.replace(PUMP, outlet=None).snapped(SHAPE, 1.0).cells.tolist() == [[3, 4]]
    assert len(WEIR.snapped(SHAPE, 1.0).faces) == 18


def test_the_loss_of_a_barrel_is_that_of_entrance_exit_and_manning_friction():
    hydraulic_radius = 2.0 * 1.0 / 6.0
    slope_per_velocity_head = 2.0 * 9.81 * 0.013**2 / hydraulic_radius ** (4.0 / 3.0)
    assert CULVERT.loss == pytest.approx(1.5 + 20.0 * slope_per_velocity_head)


def test_a_stop_level_not_given_is_the_start_level():
    assert dataclasses.replace(PUMP, stop_level=None).stop_level == PUMP.start_level


@pytest.mark.parametrize(
    ("structure", "changes", "said"),
    [
        (WEIR, {"crest": (1.0, 2.0, 3.0)}, "3 levels; 1 or 2"),
        (WEIR, {"crest": float("nan")}, "crest of the weir 'wall' is nan"),
        (WEIR, {"coefficient": 0.0}, "coefficient of the weir 'wall' is 0.0"),
        (WEIR, {"vertices": ((1.0, 1.0),)}, "1 vertices"),
        (CULVERT, {"height": 0.0}, "height of the culvert 'road' is 0.0"),
        (CULVERT, {"barrels": 0}, "barrels of the culvert 'road' is 0"),
        (CULVERT, {"outlet": ((3, 5),)}, r"\(row 3, column 5\) is inlet and outlet"),
        (CULVERT, {"inlet": ()}, "inlet of the culvert 'road' has 0 cells"),
        (CULVERT, {"inlet": ((1, 1), (1, 1))}, "each once"),
        (CULVERT, {"invert_inlet": math.inf}, "invert_inlet"),
        (PUMP, {"discharge": (1.0,)}, "2 levels and 1 discharges"),
        (PUMP, {"rating": (2.0, 2.0)}, "Entry 1 of the rating"),
        (PUMP, {"discharge": (1.0, -1.0)}, "discharge 1 of the pump 'station' is -1.0"),
        (PUMP, {"rating_against": "power"}, "'power'"),
        (PUMP, {"rating_against": "head", "outlet": None}, "out of the domain"),
        (PUMP, {"stop_level": 2.0}, "at most the start level 1.5 m"),
        (PUMP, {"start_level": None}, "stop level but no start level"),
    ],
)
def test_what_is_not_valid_is_refused_with_a_sentence_that_names_it(structure, changes, said):
    with pytest.raises(ModelError, match=said):
        dataclasses.replace(structure, **changes)


@pytest.mark.parametrize(
    ("structure", "said"),
    [
        (dataclasses.replace(WEIR, vertices=((2.0, 3.0), (40.0, 3.0))), "Vertex 1 of the weir 'wall'"),
        (dataclasses.replace(WEIR, vertices=((-0.5, -0.5), (29.5, -0.5))), "The weir 'wall' takes no face"),
        (dataclasses.replace(CULVERT, outlet=((20, 4),)), r"The culvert 'road' .* off the 20 x 30 grid"),
        (dataclasses.replace(PUMP, inlet=((5, 5),)), r"The pump 'station' .* which has no data"),
    ],
)
def test_what_has_no_place_on_the_grid_is_refused(structure, said):
    blocked = np.zeros(SHAPE, bool)
    blocked[5, 5] = True
    for fitting in (WEIR, CULVERT, PUMP):
        fitting.check_on(SHAPE, 1.0, blocked)
    with pytest.raises(ModelError, match=said):
        structure.check_on(SHAPE, 1.0, blocked)
