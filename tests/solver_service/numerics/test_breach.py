"""Breaches as numbers: what is accepted, refused and snapped."""

import dataclasses

import numpy as np
import pytest

from solver_service.errors import ModelError
from solver_service.numerics.breach import Breach, refuse_walls_in_breaches
from solver_service.numerics.structures import Weir

SHAPE = (40, 60)
DX = 5.0

BREACH = Breach("dyke", ((10.0, 20.0), (50.0, 20.0)), 6.0, 2.0, 600.0, 20.0, 100.0, across=15.0)


def test_a_breach_takes_the_strip_that_its_final_width_reaches_and_no_more():
    cells, along = BREACH.footprint(SHAPE, DX)
    assert sorted(set(cells[:, 0].tolist())) == [19, 20, 21]
    assert cells[:, 1].min() == 20
    assert cells[:, 1].max() == 40
    assert along.min() == -50.0
    assert along[(cells[:, 0] == 20) & (cells[:, 1] == 30)] == 0.0


def test_sloping_sides_reach_further_by_slope_times_depth():
    sloped = dataclasses.replace(BREACH, side_slope=2.0)
    along = sloped.footprint(SHAPE, DX)[1]
    assert along.max() - 0.5 * DX < 50.0 + 2.0 * 4.0 < along.max() + 0.5 * DX


def test_probes_stand_beside_the_strip_on_either_side_of_its_middle():
    assert sorted(BREACH.probes(DX)) == [(18, 30), (23, 30)]
    bent = dataclasses.replace(BREACH, vertices=((10.0, 20.0), (10.0, 30.0), (50.0, 30.0)))
    cells = {tuple(cell) for cell in bent.snapped(SHAPE, DX).cells.tolist()}
    assert not cells & set(bent.probes(DX))


def test_without_a_final_width_the_line_bounds_it():
    grown = dataclasses.replace(BREACH, law="verheij_van_der_knaap", width_final=None)
    assert grown.widest(DX) == 200.0


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"bottom_level": 6.0}, "bottom_level of the breach 'dyke' is 6.0; allowed is below the crest 6 m"),
        ({"duration": 0.0}, "duration"),
        ({"width_final": 10.0}, "at least the initial width 20 m"),
        ({"width_final": None}, "give width_final"),
        ({"width_initial": -1.0}, "width_initial"),
        ({"start": "soon"}, "'soon'"),
        ({"law": "froehlich"}, "'froehlich'"),
        ({"critical_velocity": 0.0}, "critical_velocity"),
        ({"start_time": float("nan")}, "start_time"),
    ],
)
def test_what_is_not_valid_is_refused_with_a_sentence_that_names_it(changes, said):
    with pytest.raises(ModelError, match=said):
        dataclasses.replace(BREACH, **changes)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"vertices": ((10.0, 20.0), (70.0, 20.0))}, "off the 40 x 60 grid"),
        ({"width_final": 201.0}, "at most the length of its line, 200 m"),
        ({"vertices": ((20.0, 2.0), (40.0, 2.0))}, "at least 2 cells off the rim"),
        ({"vertices": ((10.0, 30.0), (50.0, 30.0))}, r"\(row 30, column 28\), which has no data"),
        ({"vertices": ((10.0, 27.5), (50.0, 27.5))}, "A probe of the breach 'dyke'"),
    ],
)
def test_what_has_no_place_on_the_grid_is_refused(changes, said):
    blocked = np.zeros(SHAPE, bool)
    blocked[30, 28:32] = True
    BREACH.check_on(SHAPE, DX, blocked)
    with pytest.raises(ModelError, match=said):
        dataclasses.replace(BREACH, **changes).check_on(SHAPE, DX, blocked)


def test_a_wall_in_a_breach_is_refused_and_one_beside_it_is_not():
    beside = Weir("wall", ((0.0, 24.5), (59.0, 24.5)), 7.0)
    through = Weir("crown", ((0.0, 20.5), (59.0, 20.5)), 7.0)
    refuse_walls_in_breaches((beside,), (BREACH,), SHAPE, DX)
    with pytest.raises(
        ModelError, match=r"'dyke' reaches cell \(row 20, column 20\), at which the weir 'crown'"
    ):
        refuse_walls_in_breaches((beside, through), (BREACH,), SHAPE, DX)
