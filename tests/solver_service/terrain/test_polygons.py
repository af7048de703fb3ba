import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import GridGeometry
from solver_service.errors import TerrainError
from solver_service.terrain.polygons import cells_inside, check_ring, read_polygons

GRID = GridGeometry(nrows=8, ncols=10, dx=1.0, x0=0.0, y0=0.0)
SQUARE = [[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]]


def test_cells_inside_are_those_with_their_centre_inside() -> None:
    inside = cells_inside([[check_ring(SQUARE)]], GRID)

    assert np.argwhere(inside).tolist() == [[r, c] for r in (1, 2) for c in (1, 2, 3)]


def test_a_hole_is_left_out() -> None:
    outer = check_ring([[0, 0], [6, 0], [6, 6], [0, 6]])
    hole = check_ring([[2, 2], [4, 2], [4, 4], [2, 4]])

    assert cells_inside([[outer, hole]], GRID).sum() == 36 - 4


@given(
    st.lists(
        st.tuples(st.floats(-3, 13, width=32), st.floats(-3, 11, width=32)),
        min_size=3,
        max_size=8,
        unique=True,
    )
)
def test_any_polygon_agrees_with_shapely(points) -> None:
    import shapely

    polygon = shapely.Polygon(points)
    if not polygon.is_valid or polygon.area < 1e-3:
        return
    inside = cells_inside([[check_ring(points)]], GRID)
    for row in range(GRID.nrows):
        for col in range(GRID.ncols):
            centre = shapely.Point(*GRID.center(row, col))
            if polygon.boundary.distance(centre) > 1e-6:
                assert inside[row, col] == polygon.contains(centre)


def test_csv_polygons_stand_apart_by_names_or_empty_lines(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("x,y\n0,0\n1,0\n1,1\n\n5,5\n6,5\n6,6\n")
    (tmp_path / "b.csv").write_text(
        "polygon,x,y\nhouse,0,0\nhouse,1,0\nhouse,1,1\nbarn,5,5\nbarn,6,5\nbarn,6,6\n"
    )

    expected = [[[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]], [[(5.0, 5.0), (6.0, 5.0), (6.0, 6.0)]]]
    assert read_polygons(tmp_path / "a.csv") == expected
    assert read_polygons(tmp_path / "b.csv") == expected


def test_geojson_polygons_of_every_nesting_are_found(tmp_path: Path) -> None:
    ring = [*SQUARE, SQUARE[0]]
    shapes = [
        {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [ring]}},
        {
            "type": "Feature",
            "properties": {},
            "geometry": {"type": "MultiPolygon", "coordinates": [[ring], [ring]]},
        },
    ]
    (tmp_path / "a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": shapes}))

    assert len(read_polygons(tmp_path / "a.geojson")) == 3


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", "x,y\n0,0\n1,zwei\n", "line 3 '1,zwei' does not end in x,y"),
        ("a.csv", "0,0\n1,1\n", "2 different corners"),
        ("a.csv", "0,0\n1,1\nnan,3\n", "not finite"),
        ("a.csv", "x,y\n", "has 0 polygons"),
        ("a.geojson", "{", "cannot be read"),
        ("a.geojson", '{"type": "Point", "coordinates": [1, 2]}', "it holds a 'Point'"),
        ("a.geojson", "[1]", "cannot be read"),
        ("a.geojson", "[" * 100_000, "cannot be read"),
        ("a.shp", "", "no known format"),
    ],
)
def test_what_is_no_polygon_is_refused_by_name(tmp_path: Path, name: str, text: str, message: str) -> None:
    (tmp_path / name).write_text(text)

    with pytest.raises(TerrainError, match=f"'{name}'.*{message}"):
        read_polygons(tmp_path / name)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(TerrainError, match=r"'houses.geojson' does not exist"):
        read_polygons(tmp_path / "houses.geojson")


@given(
    st.lists(
        st.tuples(st.integers(0, 9), st.integers(0, 9)),
        min_size=4,
        max_size=8,
        unique=True,
    )
)
def test_a_ring_is_refused_exactly_where_two_of_its_sides_pass_through_each_other(points) -> None:
    import itertools

    import shapely

    sides = [shapely.LineString(pair) for pair in itertools.pairwise([*points, points[0]])]
    crossing = any(a.crosses(b) for a, b in itertools.combinations(sides, 2))
    if crossing:
        with pytest.raises(ValueError, match=r"crosses itself: the sides that begin at \(\d"):
            check_ring(points)
    else:
        assert check_ring(points) == points


def test_a_long_winding_ring_is_checked_in_no_time() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 20_000, endpoint=False)
    radius = 5.0 + np.sin(200.0 * turn)
    ring = np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])

    assert len(check_ring(ring)) == 20_000
    ring[[5000, 5001]] = ring[[5001, 5000]]
    with pytest.raises(ValueError, match="crosses itself"):
        check_ring(ring)
