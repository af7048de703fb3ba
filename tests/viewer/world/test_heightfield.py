import numpy as np
import pytest

from protocol import GridGeometry
from viewer.errors import TerrainDataError
from viewer.world import Heightfield, union_rect

GRID = GridGeometry(nrows=4, ncols=5, dx=2.0, x0=10.0, y0=20.0)
PLANE = np.array([[3.0 * col + 7.0 * row for col in range(5)] for row in range(4)], dtype=np.float32)


def test_a_sample_at_a_cell_centre_is_the_cell() -> None:
    field = Heightfield(GRID, PLANE)

    for row in range(4):
        for col in range(5):
            assert field.sample(*GRID.center(row, col)) == PLANE[row, col]


def test_a_plane_is_sampled_exactly_between_centres() -> None:
    assert Heightfield(GRID, PLANE).sample(*GRID.center(1.25, 2.5)) == pytest.approx(3.0 * 2.5 + 7.0 * 1.25)


def test_samples_past_the_border_are_those_of_the_border() -> None:
    field = Heightfield(GRID, PLANE)

    assert field.sample(-100.0, -100.0) == PLANE[0, 0]
    assert field.sample(1000.0, 1000.0) == PLANE[3, 4]


def test_arrays_are_sampled_like_single_places() -> None:
    field = Heightfield(GRID, PLANE)
    x, y = np.array([11.0, 14.3, 19.0]), np.array([21.0, 22.7, 26.5])

    assert field.sample(x, y).tolist() == [field.sample(a, b) for a, b in zip(x, y, strict=True)]


def test_changes_since_a_revision_are_one_rectangle() -> None:
    field = Heightfield(GRID, PLANE)
    field.set(PLANE + 1.0, (0, 1, 2, 3))
    seen = field.revision
    field.set(PLANE + 2.0, (1, 0, 2, 2))
    field.set(PLANE + 3.0, (3, 4, 4, 5))

    assert field.changed_since(0) == (0, 0, 4, 5)
    assert field.changed_since(seen) == (1, 0, 4, 5)
    assert field.changed_since(field.revision) is None


def test_a_revision_too_old_to_remember_means_everything() -> None:
    field = Heightfield(GRID, PLANE)
    for _ in range(200):
        field.set(PLANE, (1, 1, 2, 2))

    assert field.changed_since(3) == (0, 0, 4, 5)
    assert field.changed_since(field.revision - 1) == (1, 1, 2, 2)


def test_an_empty_change_is_no_change() -> None:
    field = Heightfield(GRID, PLANE)
    field.set(PLANE, (2, 2, 2, 4))

    assert field.revision == 0


def test_the_range_follows_an_edit() -> None:
    field = Heightfield(GRID, PLANE)
    raised = PLANE.copy()
    raised[2, 2] = 99.0
    field.set(raised, (2, 2, 3, 3))

    assert (field.z_min, field.z_max) == (0.0, 99.0)


@pytest.mark.parametrize(
    ("z_b", "part"),
    [
        (np.zeros((5, 4)), "shape"),
        (np.full((4, 5), np.nan), "not finite"),
        (np.full((4, 5), np.inf), "not finite"),
    ],
)
def test_terrain_that_does_not_fit_is_refused(z_b: np.ndarray, part: str) -> None:
    with pytest.raises(TerrainDataError, match=part):
        Heightfield(GRID, z_b)


def test_the_union_with_nothing_is_the_rectangle_itself() -> None:
    assert union_rect(None, (1, 2, 3, 4)) == (1, 2, 3, 4)
    assert union_rect((1, 2, 3, 4), None) == (1, 2, 3, 4)
    assert union_rect((1, 2, 3, 4), (0, 3, 2, 9)) == (0, 2, 3, 9)


def test_a_part_is_replaced_without_touching_the_array_that_was_given() -> None:
    field = Heightfield(GRID, PLANE)
    given = PLANE.copy()
    field.set(given)
    revision = field.revision
    field.set_part((1, 2, 3, 4), np.full((2, 2), -9.0, np.float32))

    assert np.array_equal(given, PLANE)
    assert (field.z_b[1:3, 2:4] == -9.0).all()
    assert (field.z_b == -9.0).sum() == 4
    assert field.z_min == -9.0
    assert field.changed_since(revision) == (1, 2, 3, 4)
    field.set(given, (0, 0, 1, 1))
    assert field.z_b is given or np.array_equal(field.z_b, PLANE)


# --- ground without data -----------------------------------------------------------------------------


def walled_plain() -> tuple[GridGeometry, np.ndarray, np.ndarray]:
    grid = GridGeometry(nrows=20, ncols=30, dx=10.0, x0=0.0, y0=0.0)
    z = np.zeros((20, 30), np.float32)
    outside = np.zeros((20, 30), np.bool_)
    outside[:, :8] = True
    z[outside] = 100.0
    return grid, z, outside


def test_a_wall_round_the_data_is_in_the_bed_but_not_in_the_picture() -> None:
    grid, z, outside = walled_plain()
    field = Heightfield(grid, z, outside)

    assert (field.z_b[outside] == 100.0).all()
    assert not field.drawn.any()
    assert field.z_max == 0.0
    assert field.sample(5.0, 5.0) == 0.0
    assert Heightfield(grid, z).z_max == 100.0


def test_an_edit_is_drawn_where_there_is_data_and_nowhere_else() -> None:
    grid, z, outside = walled_plain()
    field = Heightfield(grid, z, outside)
    edited = z.copy()
    edited[4:6, 5:12] += 3.0
    field.set(edited, (4, 5, 6, 12))

    assert (field.drawn[4:6, 8:12] == 3.0).all()
    assert not field.drawn[4:6, :8].any()
    assert np.array_equal(field.z_b, edited)
    assert field.z_max == 3.0


def test_what_covers_the_ground_may_come_later_and_is_counted() -> None:
    grid, z, outside = walled_plain()
    field = Heightfield(grid, z)
    picture = np.zeros((4, 6, 3), np.uint8)
    field.cover(outside, picture)

    assert field.imagery is picture
    assert (field.cover_revision, field.z_max) == (1, 0.0)
    field.cover(None, None)
    assert field.imagery is None
    assert (field.cover_revision, field.z_max) == (2, 100.0)


@pytest.mark.parametrize("imagery", [np.zeros((4, 4), np.uint8), np.zeros((4, 4, 3), np.float32)])
def test_imagery_that_is_not_8_bit_rgb_is_refused(imagery: np.ndarray) -> None:
    grid, z, _ = walled_plain()
    with pytest.raises(TerrainDataError, match="imagery"):
        Heightfield(grid, z).cover(None, imagery)


def test_a_mask_of_another_size_is_refused() -> None:
    grid, z, _ = walled_plain()
    with pytest.raises(TerrainDataError, match="without data"):
        Heightfield(grid, z, np.zeros((3, 3), np.bool_))
