"""What a flood model refuses."""

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, ModelError, Rain, Source

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
        ({"rain": Rain.uniform(0.0, 1e-5, (10, 11))}, r"rain covers \(10, 11\) rows and columns"),
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


def test_edge_segments_are_named_and_the_later_one_owns_the_faces():
    model = FloodModel(
        5.0,
        BED,
        0.03,
        boundaries=(
            EdgeBoundary("west", "open", 0, 8),
            EdgeBoundary("west", "wall", 2, 3),
            EdgeBoundary("west", "open", 6, 10),
            EdgeBoundary("east", "open", 0, 1, id="weir"),
        ),
    )
    owners, names = model.edge_segments()
    assert names == ["west-1", "west-2", "weir"]
    assert owners[0, :10].tolist() == [0, 0, -1, 0, 0, 0, 1, 1, 1, 1]
    assert owners[1, 0] == 2
    assert (owners[2:] == -1).all()
