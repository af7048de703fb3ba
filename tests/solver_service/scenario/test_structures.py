import math
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import ServiceError
from solver_service.numerics.structures import Culvert, Pump, Weir
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY, loaded
from tests.solver_service.tiny_case import valley, write_case

WEIR = "\n[[weir]]\nline = [[1100.0, 2000.0], [1100.0, 2240.0]]\n"
CULVERT = "\n[[culvert]]\ninlet = [1055.0, 2125.0]\noutlet = [1155.0, 2125.0]\n"
PUMP = "\n[[pump]]\ninlet = [1055.0, 2125.0]\n"


def test_a_weir_stands_on_the_faces_along_its_line(tmp_path: Path) -> None:
    case = loaded(tmp_path, WEIR + "crest = [304.0, 305.0]\n")

    (weir,) = case.model.structures
    assert isinstance(weir, Weir)
    assert weir.id == "weir-1"
    assert weir.crest == (4.0, 5.0)
    faces = weir.snapped(case.grid.shape, case.grid.dx).faces
    # The eastern faces of column 9, whose centres lie at x = 1095.
    assert {tuple(face) for face in faces.tolist()} == {(row, 9, 0) for row in range(24)}


def test_a_culvert_joins_two_cells_at_their_ground(tmp_path: Path) -> None:
    (pipe,) = loaded(tmp_path, CULVERT + "diameter = 2.0\nbarrels = 3\nboth_ways = false\n").model.structures

    assert isinstance(pipe, Culvert)
    assert (pipe.inlet, pipe.outlet, pipe.length) == (((12, 5),), ((12, 15),), 100.0)
    assert pipe.invert_inlet == pytest.approx(valley()[12, 5] - 300.0, abs=1e-4)
    assert (pipe.width * pipe.height, pipe.height) == (pytest.approx(math.pi), 2.0)
    assert (pipe.barrels, pipe.both_ways) == (3, False)


def test_levels_of_a_culvert_count_from_the_datum(tmp_path: Path) -> None:
    keys = "width = 3.0\nheight = 1.5\nlength = 120.0\nradius = 10.0\n"
    keys += "inlet_level = 302.5\noutlet_level = 302.0\n"

    (box,) = loaded(tmp_path, CULVERT + keys).model.structures

    assert (box.invert_inlet, box.invert_outlet, box.length) == (2.5, 2.0, 120.0)
    assert len(box.inlet) == len(box.outlet) == 5


def test_a_pump_follows_its_rating_and_its_switch(tmp_path: Path) -> None:
    text = PUMP + 'outlet = [1355.0, 2125.0]\nrating = "p.csv"\nstart_level = 303.5\nstop_level = 303.0\n'
    write_case(tmp_path, DRY + text)
    (tmp_path / "p.csv").write_text("level,discharge\n303,1\n305,2.5\n")

    (pump,) = load_case(tmp_path).model.structures

    assert isinstance(pump, Pump)
    assert (pump.rating, pump.discharge, pump.rating_against) == ((3.0, 5.0), (1.0, 2.5), "level")
    assert (pump.start_level, pump.stop_level) == (3.5, 3.0)

    (tmp_path / "p.csv").write_text("head,discharge\n0,2\n5,1\n")
    (pump,) = load_case(tmp_path).model.structures
    assert (pump.rating, pump.rating_against) == ((0.0, 5.0), "head")


def test_a_pump_without_outlet_empties_the_terrain(tmp_path: Path) -> None:
    (pump,) = loaded(tmp_path, PUMP + "discharge = 2.0\n").model.structures

    assert (pump.outlet, pump.discharge) == (None, (2.0,))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (WEIR, "crest is missing; an elevation in m is allowed"),
        (WEIR + "crest = [304.0, 305.0, 306.0]", "a list of 2 finite numbers"),
        (WEIR + "crest = 30400.0", "crest is 30400.0; an elevation in m"),
        (WEIR + "crest = 3040.0", "the ground reaches from 301.05 to 305.64 m; a level within 1000 m"),
        (WEIR + "crest = 304.0\ncoefficient = 17.0", "coefficient is 17.0; a number from 0.1 to 4"),
        ("[[weir]]\ncrest = 304.0\nline = [[1100.0, 2000.0]]", "2 to 4096 points"),
        (
            "[[weir]]\ncrest = 304.0\nline = [[1100.0, 2000.0], [1100.0, 2000.0]]",
            "points differ each",
        ),
        ("[[weir]]\ncrest = 304.0\nline = [[1100.0, 2000.0], [9.0, 9.0]]", r"\(9, 9\) lies off the terrain"),
        ("[[weir]]\ncrest = 304.0\nline = [[1000.0, 2000.0], [1000.0, 2240.0]]", "weir-1"),
        (CULVERT, "has no opening; either diameter, or width and height"),
        (CULVERT + "width = 2.0", "has width; either diameter, or width and height"),
        (CULVERT + "width = 2.0\nheight = 1.0\ndiameter = 3.0", "has diameter and width"),
        (CULVERT + "diameter = 0.0", "diameter is 0.0; a diameter in m above 0"),
        (CULVERT + "diameter = 1.0\nbarrels = 1.5", "barrels is 1.5; a whole number"),
        (
            CULVERT + "diameter = 1.0\nradius = 60.0",
            r"its cell .* is one of the inlet",
        ),
        (CULVERT + "diameter = 1.0\ninlet_level = 5000.0", "inlet_level is 5000.0; the ground reaches"),
        (
            "[[culvert]]\ninlet = [0.0, 0.0]\noutlet = [1155.0, 2125.0]\ndiameter = 1.0",
            "lies off the terrain",
        ),
        (PUMP, "discharge is missing; either 'discharge' in m3/s or 'rating'"),
        (PUMP + "discharge = -1.0", "discharge is -1.0; a discharge in m3/s from 0"),
        (PUMP + "discharge = 1.0\nstart_level = 1.0\nstop_level = 2.0", "stop level"),
        (PUMP + "discharge = 1.0\nstop_level = 302.0", "stop level but no start level"),
        (PUMP + 'rating = "h.csv"', "a pump without outlet needs a rating against 'level'"),
        (PUMP + 'rating = "x.csv"', "x.csv: line 1 is 'q,level'; 'level,discharge' or 'head,discharge'"),
        (PUMP + 'rating = "d.csv"', "d.csv: line 3 is at 1 m, not above 2 m"),
        (PUMP + 'discharge = 1.0\nid = "east-1"', "'east-1' is the id of a structure, and of a boundary"),
        (PUMP + 'discharge = 1.0\nid = ""', "'' is the id of a structure; each its own"),
    ],
)
def test_a_bad_structure_is_told(tmp_path: Path, table: str, message: str) -> None:
    write_case(tmp_path, f"{DRY}\n{table}\n")
    (tmp_path / "h.csv").write_text("head,discharge\n0,1\n")
    (tmp_path / "x.csv").write_text("q,level\n0,1\n")
    (tmp_path / "d.csv").write_text("level,discharge\n2,1\n1,1\n")

    with pytest.raises(ServiceError, match=message) as caught:
        load_case(tmp_path)

    assert "\n" not in str(caught.value)


def test_a_structure_on_a_hole_is_refused(tmp_path: Path) -> None:
    bed = valley()
    bed[12, 5] = np.nan

    with pytest.raises(ServiceError, match=r"inlet is \[1055.0, 2125.0\]; a place with terrain data"):
        loaded(tmp_path, PUMP + "discharge = 1.0\n", bed)
