import math

import numpy as np
import pytest

from viewer.lod import SwitchTable, pixels_per_slope, screen_error_factor
from viewer.world import Camera


@pytest.fixture
def errors(rng: np.random.Generator) -> np.ndarray:
    table = rng.random((6, 5, 7)).astype(np.float32) * np.arange(6, dtype=np.float32)[:, None, None]
    return table


def test_a_block_gets_the_coarsest_level_beyond_its_switch_distance(errors: np.ndarray) -> None:
    table = SwitchTable(errors)
    distance = np.linspace(1.0, 3000.0, 35, dtype=np.float32)
    switch = table.distances(800.0, 2.0)
    levels = table.levels(distance, 800.0, 2.0)

    for block in range(35):
        allowed = [level for level in range(6) if switch[level, block] <= distance[block]]
        assert levels[block] == max(allowed)


def test_switch_distances_never_shrink_with_the_level(errors: np.ndarray) -> None:
    assert (np.diff(SwitchTable(errors).distances(800.0, 2.0), axis=0) >= 0.0).all()


def test_half_the_threshold_doubles_the_distances(errors: np.ndarray) -> None:
    table = SwitchTable(errors)

    assert table.distances(800.0, 1.0) == pytest.approx(2.0 * table.distances(800.0, 2.0))


def test_refreshing_some_blocks_leaves_the_others(errors: np.ndarray) -> None:
    table = SwitchTable(errors)
    before = table.distances(1.0, 1.0).reshape(6, 5, 7)
    table.update(np.full((6, 2, 3), 50.0, dtype=np.float32), None, (1, 2, 3, 5))
    after = table.distances(1.0, 1.0).reshape(6, 5, 7)

    assert (after[:, 1:3, 2:5] == 50.0).all()
    mask = np.ones((5, 7), dtype=bool)
    mask[1:3, 2:5] = False
    assert np.array_equal(after[:, mask], before[:, mask])


@pytest.mark.parametrize("pitch_deg", [2.0, 30.0, 60.0, 90.0])
def test_no_vertical_error_covers_more_pixels_than_the_bound(
    pitch_deg: float, rng: np.random.Generator
) -> None:
    width, height = 1280, 720
    camera = Camera((0.0, 0.0, 0.0), 1000.0, 0.7, math.radians(pitch_deg))
    matrix = camera.projection(width / height, 1.0, 1e5) @ camera.view_matrix()
    bound = pixels_per_slope(height, camera.fov_y)
    bound *= screen_error_factor(camera.elevation, camera.fov_y, width / height)
    t = math.tan(camera.fov_y / 2)
    n = 20_000
    depth = rng.uniform(50.0, 3000.0, n)
    ndc = rng.uniform(-1.0, 1.0, (n, 2))
    points = (
        camera.eye
        + depth[:, None] * camera.forward
        + (depth * ndc[:, 0] * t * width / height)[:, None] * camera.right
        + (depth * ndc[:, 1] * t)[:, None] * camera.up
    )
    error = rng.uniform(-1.0, 1.0, n)

    def pixels(places: np.ndarray) -> np.ndarray:
        clip = np.column_stack([places, np.ones(n)]) @ matrix.T
        return clip[:, :2] / clip[:, 3:] * [width / 2, height / 2]

    moved = points + error[:, None] * np.array([0.0, 1.0, 0.0])
    distance = np.minimum(
        np.linalg.norm(points - camera.eye, axis=1), np.linalg.norm(moved - camera.eye, axis=1)
    )
    shift = np.linalg.norm(pixels(moved) - pixels(points), axis=1)
    share = shift * distance / (np.abs(error) * bound)

    assert share.max() <= 1.0 + 1e-6
    assert share.max() > 0.6
