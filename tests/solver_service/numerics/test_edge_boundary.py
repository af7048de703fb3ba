"""What an edge segment and a set of them refuse."""

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, ModelError
from solver_service.numerics.edge_boundary import EDGES, edge_cells

BED = np.zeros((10, 12), np.float32)


def model(*boundaries, **kw):
    return FloodModel(5.0, BED, 0.03, boundaries=boundaries, **kw)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("up", "open", 0, 3), "edge"),
        (("west", "sluice", 0, 3), "kind"),
        (("west", "open", 3, 3), "first < last"),
        (("west", "stage", 0, 3), "no series"),
        (("west", "discharge", 0, 3, "", [0.0, 0.0], [1.0, 2.0]), "not after"),
        (("west", "stage", 0, 3, "", [0.0, 1.0], [1.0, np.nan]), "Entry 1 of the series of a stage"),
        (("west", "open", 0, 3, "", [0.0], [1.0]), "only stage and discharge"),
        (("west", "normal_depth", 0, 3), "slope None"),
        (("west", "normal_depth", 0, 3, "", None, None, 0.0), "0 < slope <= 1"),
        (("west", "normal_depth", 0, 3, "", None, None, float("nan")), "0 < slope <= 1"),
        (("west", "stage", 0, 3, "", [0.0], [1.0], 0.1), "only normal_depth"),
    ],
)
def test_a_boundary_that_is_not_valid_is_refused(arguments, words):
    with pytest.raises(ModelError, match=words) as caught:
        EdgeBoundary(*arguments)
    assert "\n" not in str(caught.value)


def test_levels_and_discharges_may_be_negative():
    assert EdgeBoundary("west", "stage", 0, 3, "", [0, 1], [-2, -3]).values.tolist() == [-2.0, -3.0]
    assert EdgeBoundary("west", "discharge", 0, 3, "", [0], [-2]).times.dtype == np.float64


def test_a_segment_that_leaves_its_edge_is_refused():
    with pytest.raises(ModelError, match="north boundary ends at cell 13"):
        model(EdgeBoundary("north", "open", 0, 13))


def test_overlapping_segments_are_refused_and_touching_ones_are_not():
    with pytest.raises(ModelError, match="Two west boundaries share cell 4"):
        model(EdgeBoundary("west", "open", 0, 5), EdgeBoundary("west", "wall", 4, 6))
    assert model(EdgeBoundary("west", "open", 0, 5), EdgeBoundary("west", "wall", 5, 6))


def test_a_name_given_twice_is_refused():
    with pytest.raises(ModelError, match="'tide'"):
        model(EdgeBoundary("west", "open", 0, 5, "tide"), EdgeBoundary("east", "open", 0, 5, "tide"))


def test_a_discharge_into_blocked_cells_alone_is_refused():
    blocked = np.zeros(BED.shape, bool)
    blocked[2:5, 0] = True
    with pytest.raises(ModelError, match="no cell with data"):
        model(EdgeBoundary("west", "discharge", 2, 5, "", [0.0], [1.0]), blocked=blocked)
    assert model(EdgeBoundary("west", "discharge", 2, 6, "", [0.0], [1.0]), blocked=blocked)


def test_cells_along_an_edge_run_from_the_south_and_the_west():
    raster = np.arange(12).reshape(3, 4)
    assert [edge_cells(raster, edge).tolist() for edge in EDGES] == [
        [0, 4, 8],
        [3, 7, 11],
        [0, 1, 2, 3],
        [8, 9, 10, 11],
    ]
