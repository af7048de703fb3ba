import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from viewer.world.polyline import distance_to_line, is_within, nearest_vertex, simplified

SQUARE = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]
COORDINATE = st.floats(-1e4, 1e4, allow_nan=False)
POINTS = st.lists(st.tuples(COORDINATE, COORDINATE), min_size=2, max_size=40)


def test_a_straight_stroke_becomes_its_two_ends() -> None:
    assert simplified([(float(x), 0.0) for x in range(200)], 0.5) == [(0.0, 0.0), (199.0, 0.0)]


def test_a_corner_is_kept_and_a_wobble_is_not() -> None:
    stroke = [(0.0, 0.0), (5.0, 0.3), (10.0, 0.0), (10.2, 5.0), (10.0, 10.0)]
    assert simplified(stroke, 0.5) == [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]
    assert simplified(stroke, 0.1) == stroke


@given(POINTS, st.floats(0.01, 100.0))
def test_no_point_left_out_is_farther_from_the_line_than_the_tolerance(
    points: list[tuple[float, float]], tolerance: float
) -> None:
    line = simplified(points, tolerance)
    assert (line[0], line[-1]) == (points[0], points[-1])
    assert set(line) <= set(points)
    assert all(distance_to_line(line, point) <= tolerance * (1.0 + 1e-9) + 1e-9 for point in points)


def test_a_stroke_of_one_point_stays() -> None:
    assert simplified([(1.0, 2.0)], 1.0) == [(1.0, 2.0)]
    assert simplified([], 1.0) == []


def test_the_distance_is_to_the_nearest_segment_or_its_end() -> None:
    line = SQUARE[:3]
    assert distance_to_line(line, (5.0, 3.0)) == pytest.approx(3.0)
    assert distance_to_line(line, (13.0, 14.0)) == pytest.approx(5.0)
    assert distance_to_line(line, (10.0, 7.0)) == 0.0
    assert distance_to_line([(1.0, 1.0)], (4.0, 5.0)) == pytest.approx(5.0)
    assert distance_to_line([(1.0, 1.0), (1.0, 1.0)], (4.0, 5.0)) == pytest.approx(5.0)


def test_the_line_is_not_closed_but_a_ring_given_with_its_first_point_again_is() -> None:
    assert distance_to_line(SQUARE, (-1.0, 5.0)) == pytest.approx(math.hypot(1.0, 5.0))
    assert distance_to_line([*SQUARE, SQUARE[0]], (-1.0, 5.0)) == pytest.approx(1.0)


def test_the_nearest_vertex_comes_with_its_distance() -> None:
    assert nearest_vertex(SQUARE, (8.0, 10.0)) == (2, pytest.approx(2.0))


def test_a_place_is_inside_by_the_even_odd_rule() -> None:
    assert is_within(SQUARE, (5.0, 5.0))
    assert not is_within(SQUARE, (11.0, 5.0))
    twice = [*SQUARE, *SQUARE]
    assert not is_within(twice, (5.0, 5.0))
    bow_tie = [(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]
    assert is_within(bow_tie, (9.0, 5.0))
    assert not is_within(bow_tie, (5.0, 9.0))
