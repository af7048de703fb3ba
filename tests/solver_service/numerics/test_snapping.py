"""Lines on the grid: chains of faces and strips of cells."""

import numpy as np
import pytest

from solver_service.errors import ModelError
from solver_service.numerics.snapping import (
    EAST_FACE,
    NORTH_FACE,
    Snapped,
    check_vertices,
    face_chain,
    line_cells,
    line_length,
    nearest_on_line,
)

SHAPE = (20, 30)


def sides(faces, shape):
    """Cells reached from the south-western corner without crossing a face of the chain."""
    closed = {tuple(face) for face in faces.tolist()}
    seen, todo = {(0, 0)}, [(0, 0)]
    while todo:
        row, col = todo.pop()
        for other, face in (
            ((row, col + 1), (row, col, EAST_FACE)),
            ((row, col - 1), (row, col - 1, EAST_FACE)),
            ((row + 1, col), (row, col, NORTH_FACE)),
            ((row - 1, col), (row - 1, col, NORTH_FACE)),
        ):
            inside = 0 <= other[0] < shape[0] and 0 <= other[1] < shape[1]
            if inside and other not in seen and face not in closed:
                seen.add(other)
                todo.append(other)
    return len(seen)


@pytest.mark.parametrize(
    "vertices",
    [
        ((-0.5, 7.3), (29.5, 7.3)),
        ((-0.5, 2.0), (12.2, 14.7), (29.5, 9.0)),
        ((4.4, -0.5), (25.0, 19.5)),
        ((29.5, 18.0), (-0.5, 1.0)),
    ],
)
def test_a_chain_across_the_grid_parts_it_without_a_gap(vertices):
    faces = face_chain(vertices, SHAPE)
    reached = sides(faces, SHAPE)
    assert 0 < reached < SHAPE[0] * SHAPE[1]
    assert len({tuple(face) for face in faces.tolist()}) == len(faces)
    for k in range(len(faces)):
        assert sides(np.delete(faces, k, axis=0), SHAPE) == SHAPE[0] * SHAPE[1], "any face less is a gap"


def test_a_chain_stays_within_a_cell_of_its_line_and_has_the_shortest_staircase():
    vertices = ((3.0, 2.0), (22.0, 13.0))
    faces = face_chain(vertices, SHAPE)
    middle = Snapped(np.zeros((0, 2), np.int32), faces).face_lines().mean(axis=1)
    assert nearest_on_line(middle[:, 0], middle[:, 1], vertices).distance.max() < 1.0
    assert len(faces) == 19 + 11


def test_faces_on_the_rim_are_left_out():
    assert len(face_chain(((-0.5, -0.5), (29.5, -0.5)), SHAPE)) == 0
    assert len(face_chain(((-0.5, 0.5), (29.5, 0.5)), SHAPE)) == 30


def test_face_lines_are_sides_of_length_one_between_the_two_cells():
    faces = np.array([[3, 4, EAST_FACE], [3, 4, NORTH_FACE]], np.int32)
    lines = Snapped(np.zeros((0, 2), np.int32), faces).face_lines()
    assert lines.tolist() == [[[4.5, 2.5], [4.5, 3.5]], [[3.5, 3.5], [4.5, 3.5]]]


def test_a_strip_holds_the_centres_within_half_its_width():
    cells = line_cells(((5.0, 10.0), (15.0, 10.0)), 4.0, SHAPE)
    assert sorted(set(cells[:, 0].tolist())) == [8, 9, 10, 11, 12]
    assert [3, 13] not in cells.tolist()
    inner = cells[(cells[:, 1] >= 5) & (cells[:, 1] <= 15)]
    assert len(inner) == 5 * 11


@pytest.mark.parametrize("end", [(21.4, 16.9), (21.4, 2.2), (3.2, 18.0)])
def test_a_strip_without_width_is_a_chain_of_cells_without_a_gap(end):
    cells = line_cells(((3.3, 2.1), end), 0.0, SHAPE)
    order = np.argsort(nearest_on_line(*cells[:, ::-1].T.astype(float), ((3.3, 2.1), end)).along)
    assert np.abs(np.diff(cells[order], axis=0)).max() <= 1


def test_the_nearest_place_counts_the_way_along_all_segments():
    vertices = ((0.0, 0.0), (10.0, 0.0), (10.0, 5.0))
    nearest = nearest_on_line(np.array([4.0, 12.0, 20.0]), np.array([3.0, 2.0, 9.0]), vertices)
    assert nearest.along.tolist() == [4.0, 12.0, 15.0]
    assert nearest.segment.tolist() == [0, 1, 1]
    assert nearest.distance.tolist() == [3.0, 2.0, pytest.approx(np.hypot(10.0, 4.0))]
    assert line_length(vertices) == 15.0


@pytest.mark.parametrize(
    "vertices", [((1.0, 2.0),), ((1.0, 2.0), (float("nan"), 3.0)), ((1, 2), (1, 2), (3, 4))]
)
def test_lines_that_are_none_are_refused(vertices):
    with pytest.raises(ModelError, match="of the wall"):
        check_vertices("the wall", vertices)
