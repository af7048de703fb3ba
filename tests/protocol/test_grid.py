import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import GridError, GridGeometry

GRID = GridGeometry(nrows=3, ncols=5, dx=10.0, x0=100.0, y0=200.0, datum_offset=50.0)


def test_row_0_is_in_the_south_and_column_0_in_the_west() -> None:
    assert GRID.center(0, 0) == (105.0, 205.0)
    assert GRID.center(2, 4) == (145.0, 225.0)


def test_the_extent_is_that_of_the_outer_edges() -> None:
    assert GRID.extent == (100.0, 200.0, 150.0, 230.0)
    assert (GRID.shape, GRID.cell_count) == ((3, 5), 15)


def test_points_on_the_edge_are_contained_and_beyond_are_not() -> None:
    assert GRID.contains(100.0, 230.0)
    assert not GRID.contains(99.999, 210.0)
    assert not GRID.contains(120.0, 230.001)
    assert not GRID.contains(math.nan, 210.0)


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_to_cell_undoes_center(row: float, col: float) -> None:
    assert GRID.to_cell(*GRID.center(row, col)) == pytest.approx((row, col), abs=1e-6)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("nrows", 0),
        ("ncols", -3),
        ("ncols", 1 << 17),
        ("dx", 0.0),
        ("dx", math.nan),
        ("dx", math.inf),
        ("x0", math.inf),
        ("y0", math.nan),
        ("datum_offset", math.nan),
    ],
)
def test_an_impossible_number_is_refused_by_name(name: str, value: Any) -> None:
    numbers = {"nrows": 3, "ncols": 5, "dx": 10.0} | {name: value}
    with pytest.raises(GridError, match=name):
        GridGeometry(**numbers)


def test_too_many_cells_are_refused() -> None:
    with pytest.raises(GridError, match="cells"):
        GridGeometry(nrows=1 << 16, ncols=1 << 16, dx=1.0)
