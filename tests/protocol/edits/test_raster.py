"""The raster against a scalar one that knows nothing of NumPy: Bresenham's loop and exact fractions."""

import math
import time
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import EditError, EditLine, GridGeometry, limits, rasterise_edit
from tests.protocol.edits.examples import Points, area, line

GRID = GridGeometry(nrows=23, ncols=31, dx=2.5, x0=-10.0, y0=1000.0)
XMIN, YMIN, XMAX, YMAX = GRID.extent

points = st.tuples(st.floats(XMIN, XMAX), st.floats(YMIN, YMAX))
corners = st.tuples(st.integers(0, GRID.ncols), st.integers(0, GRID.nrows)).map(
    lambda cell: (XMIN + 2.5 * cell[0], YMIN + 2.5 * cell[1])
)
polylines = st.lists(points | corners, min_size=2, max_size=6)
rings = st.lists(points | corners, min_size=3, max_size=8)
widths = st.floats(0.01, 30.0) | st.sampled_from([2.5, 5.0, 7.5])


def units(x: float, y: float) -> tuple[int, int]:
    """A vertex in 1/1024 of a cell."""
    return (round((x - GRID.x0) / GRID.dx * 1024), round((y - GRID.y0) / GRID.dx * 1024))


def bresenham_cells(a: tuple[int, int], b: tuple[int, int]) -> set[tuple[int, int]]:
    """The textbook loop: one step along the longer side, and one aside when the error has grown to a half."""
    (col, row), (col_end, row_end) = (
        (min(x // 1024, GRID.ncols - 1), min(y // 1024, GRID.nrows - 1)) for x, y in (a, b)
    )
    dcol, drow = abs(col_end - col), abs(row_end - row)
    col_step, row_step = (1 if col_end > col else -1), (1 if row_end > row else -1)
    cells = {(row, col)}
    error = max(dcol, drow)
    for _ in range(max(dcol, drow)):
        error += 2 * min(dcol, drow)
        aside = error >= 2 * max(dcol, drow)
        error -= 2 * max(dcol, drow) if aside else 0
        if dcol >= drow or aside:
            col += col_step
        if drow > dcol or aside:
            row += row_step
        cells.add((row, col))
    return cells


def nearest(p: tuple[int, int], a: tuple[int, int], b: tuple[int, int]) -> tuple[Fraction, Fraction]:
    """Fraction of the segment and squared distance of its point nearest to p."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    t = Fraction(0)
    if length2:
        t = min(max(Fraction((p[0] - a[0]) * dx + (p[1] - a[1]) * dy, length2), Fraction(0)), Fraction(1))
    return t, (p[0] - a[0] - t * dx) ** 2 + (p[1] - a[1] - t * dy) ** 2


def rasterise_slowly(edit: EditLine) -> dict[tuple[int, int], set[Fraction]]:
    """Covered cells, and the positions of the nearest points among the segments that cover them."""
    vertices = [units(*vertex) for vertex in edit.vertices]
    segments = list(pairwise(vertices))
    thin = [bresenham_cells(a, b) for a, b in segments]
    half2 = Fraction(round(edit.width / GRID.dx * 1024), 2) ** 2
    cells = {}
    for row in range(GRID.nrows):
        for col in range(GRID.ncols):
            centre = (1024 * col + 512, 1024 * row + 512)
            found = []
            for number, (a, b) in enumerate(segments):
                t, distance2 = nearest(centre, a, b)
                if distance2 <= half2 or (row, col) in thin[number]:
                    found.append((distance2, number + t))
            if found:
                least = min(distance2 for distance2, _ in found)
                cells[row, col] = {position for distance2, position in found if distance2 == least}
    return cells


@given(polylines, widths)
def test_a_line_covers_what_the_scalar_raster_covers(vertices: Points, width: float) -> None:
    edit = line(vertices, width)
    rows, cols, position = rasterise_edit(edit, GRID)
    expected = rasterise_slowly(edit)
    assert list(zip(rows.tolist(), cols.tolist(), strict=True)) == sorted(expected)
    assert position is not None
    for row, col, found in zip(rows.tolist(), cols.tolist(), position.tolist(), strict=True):
        assert any(abs(found - float(each)) < 1e-9 for each in expected[row, col])


def crosses(p: tuple[int, int], a: tuple[int, int], b: tuple[int, int]) -> bool:
    """Whether the side from a to b passes west of p or through it, in p's row."""
    if (a[1] <= p[1]) == (b[1] <= p[1]):
        return False
    return a[0] + Fraction((p[1] - a[1]) * (b[0] - a[0]), b[1] - a[1]) <= p[0]


@given(rings)
def test_an_area_covers_the_centres_inside_by_the_even_odd_rule(vertices: Points) -> None:
    rows, cols, position = rasterise_edit(area(vertices), GRID)
    corner = [units(*vertex) for vertex in vertices]
    sides = list(zip(corner, corner[1:] + corner[:1], strict=True))
    expected = [
        (row, col)
        for row in range(GRID.nrows)
        for col in range(GRID.ncols)
        if sum(crosses((1024 * col + 512, 1024 * row + 512), a, b) for a, b in sides) % 2
    ]
    assert list(zip(rows.tolist(), cols.tolist(), strict=True)) == expected
    assert position is None


@given(rings, st.integers(0, 7))
def test_an_area_does_not_depend_on_where_its_ring_begins_or_which_way_it_goes(
    vertices: Points, start: int
) -> None:
    turned = list(vertices[start:]) + list(vertices[:start])
    first = rasterise_edit(area(vertices), GRID)
    for other in (turned, turned[::-1], [*turned, turned[0]]):
        rows, cols, _ = rasterise_edit(area(other), GRID)
        np.testing.assert_array_equal(rows, first[0])
        np.testing.assert_array_equal(cols, first[1])


def test_areas_side_by_side_share_no_cell_and_leave_none_out() -> None:
    left = rasterise_edit(area([(0.0, 1010.0), (21.25, 1010.0), (21.25, 1030.0), (0.0, 1030.0)]), GRID)
    right = rasterise_edit(area([(21.25, 1010.0), (40.0, 1010.0), (40.0, 1030.0), (21.25, 1030.0)]), GRID)
    both = rasterise_edit(area([(0.0, 1010.0), (40.0, 1010.0), (40.0, 1030.0), (0.0, 1030.0)]), GRID)
    cells = [set(zip(r.tolist(), c.tolist(), strict=True)) for r, c, _ in (left, right, both)]
    assert not cells[0] & cells[1]
    assert cells[0] | cells[1] == cells[2]


@given(polylines)
def test_a_line_thinner_than_a_cell_has_no_gaps(vertices: Points) -> None:
    rows, cols, _ = rasterise_edit(line(vertices, 1e-3), GRID)
    covered = set(zip(rows.tolist(), cols.tolist(), strict=True))
    reached, edge = set(), {next(iter(covered))}
    while edge:
        reached |= edge
        edge = {
            (row + i, col + j) for row, col in edge for i in (-1, 0, 1) for j in (-1, 0, 1)
        } & covered - reached
    assert reached == covered


@pytest.mark.parametrize(
    ("vertices", "expected"),
    [
        ([(0.0, 1020.0), (20.0, 1020.0)], {0.0: 0.0, 20.0: 1.0}),
        ([(0.0, 1020.0), (10.0, 1020.0), (20.0, 1020.0)], {0.0: 0.0, 10.0: 1.0, 15.0: 1.5, 20.0: 2.0}),
    ],
)
def test_the_position_counts_vertices_and_fractions_of_segments(
    vertices: Points, expected: dict[float, float]
) -> None:
    _, cols, position = rasterise_edit(line(vertices, 2.5), GRID)
    assert position is not None
    found = dict(zip(cols.tolist(), position.tolist(), strict=True))
    for x, value in expected.items():
        col = math.floor((x - GRID.x0) / GRID.dx)
        step = 1.25 * (len(vertices) - 1) / 20.0
        assert found[col] == pytest.approx(min(value + step, len(vertices) - 1), abs=1e-3)


@pytest.mark.parametrize(
    "vertex", [(XMIN - 0.1, 1010.0), (0.0, YMAX + 0.1), (1e9, 1e9), (math.nextafter(XMAX, 1e9), YMAX)]
)
def test_a_vertex_outside_the_terrain_is_refused_with_its_number(vertex: tuple[float, float]) -> None:
    with pytest.raises(EditError, match=r"'e' vertex 1 .* outside the terrain"):
        rasterise_edit(line([(0.0, 1010.0), vertex]), GRID)


def test_a_line_wider_than_the_terrain_covers_it_all() -> None:
    rows, _, _ = rasterise_edit(line([(XMIN, YMIN), (XMAX, YMAX)], 99_999.0), GRID)
    assert rows.size == GRID.cell_count


def test_an_edit_that_is_too_much_work_is_refused_at_once() -> None:
    grid = GridGeometry(nrows=5000, ncols=5000, dx=1.0)
    vertices = [(10.0 + i % 2, 10.0 + i) for i in range(limits.MAX_VERTICES)]
    started = time.perf_counter()
    with pytest.raises(EditError, match="narrower"):
        rasterise_edit(line(vertices, 2000.0), grid)
    assert time.perf_counter() - started < 2.0


def test_an_edit_of_200_cells_takes_less_than_5_ms() -> None:
    grid = GridGeometry(nrows=2000, ncols=2000, dx=5.0)
    edit = line([(100.0, 100.0), (900.0, 700.0)], 25.0)
    best = math.inf
    for _ in range(20):
        started = time.perf_counter()
        rasterise_edit(edit, grid)
        best = min(best, time.perf_counter() - started)
    assert best < 5e-3
