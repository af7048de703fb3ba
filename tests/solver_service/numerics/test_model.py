"""What a flood model refuses."""

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, ModelError, Source

BED = np.zeros((10, 12), np.float32)


def with_value(value, row=3, col=4):
    raster = BED.copy()
    raster[row, col] = value
    return raster


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"z_b": with_value(np.nan)}, r"bed is nan in cell \(row 3, column 4\)"),
        ({"z_b": np.zeros((1, 5))}, "at least 2 cells"),
        ({"dx": 0.0}, "cell size"),
        ({"dx": float("nan")}, "cell size"),
        ({"manning_n": with_value(-0.1)}, "roughness is -0.1"),
        ({"manning_n": float("nan")}, "roughness is nan"),
        ({"manning_n": np.zeros((3, 3))}, "roughness has the shape"),
        ({"blocked": np.zeros((3, 3), bool)}, "blocked mask has the shape"),
        ({"boundaries": (EdgeBoundary("north", "open", 0, 13),)}, "north boundary ends at cell 13"),
        ({"rain": (np.array([0.0, 1.0]), np.array([1.0, np.inf]))}, "Entry 1 of the series of rain"),
        ({"sources": (Source([3], [4], [0.0], [1.0]),), "blocked": with_value(1.0).astype(bool)}, "no data"),
    ],
)
def test_what_is_not_valid_is_refused_in_one_sentence(arguments, words):
    with pytest.raises(ModelError, match=words) as caught:
        FloodModel(**{"dx": 5.0, "z_b": BED, "manning_n": 0.03, **arguments})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("up", "open", 0, 3), "edge"),
        (("west", "sluice", 0, 3), "kind"),
        (("west", "open", 3, 3), "first < last"),
    ],
)
def test_a_boundary_that_is_not_valid_is_refused(arguments, words):
    with pytest.raises(ModelError, match=words):
        EdgeBoundary(*arguments)


def test_a_source_that_names_a_cell_twice_is_refused():
    with pytest.raises(ModelError, match="twice"):
        Source([1, 1], [2, 2], [0.0], [1.0])
