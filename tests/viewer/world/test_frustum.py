import math

import numpy as np
import pytest

from viewer.world import Camera, Frustum


@pytest.fixture
def matrix() -> np.ndarray:
    camera = Camera((0.0, 0.0, 0.0), 300.0, math.radians(33.0), math.radians(25.0))
    return camera.projection(1.6, 5.0, 2000.0) @ camera.view_matrix()


def test_a_box_with_a_visible_point_is_never_left_out(matrix: np.ndarray, rng: np.random.Generator) -> None:
    centre = rng.uniform(-800.0, 800.0, (3, 2000))
    half = rng.uniform(1.0, 60.0, (3, 2000))
    kept = Frustum(matrix).intersects_boxes(centre, half)
    inside_any = np.zeros(2000, dtype=bool)
    for _ in range(200):
        point = centre + half * rng.uniform(-1.0, 1.0, (3, 2000))
        clip = matrix @ np.vstack([point, np.ones(2000)])
        inside_any |= (np.abs(clip[:3]) <= clip[3]).all(axis=0)

    assert inside_any.sum() > 100
    assert not (inside_any & ~kept).any()


def test_most_boxes_out_of_sight_are_left_out(matrix: np.ndarray, rng: np.random.Generator) -> None:
    centre = rng.uniform(-800.0, 800.0, (3, 2000))
    kept = Frustum(matrix).intersects_boxes(centre, np.full((3, 2000), 1.0))
    clip = matrix @ np.vstack([centre, np.ones(2000)])
    seen = (np.abs(clip[:3]) <= clip[3]).all(axis=0)

    assert kept.sum() < seen.sum() + 60
    assert kept.sum() < 1000


def test_a_box_behind_the_eye_is_left_out(matrix: np.ndarray) -> None:
    camera = Camera((0.0, 0.0, 0.0), 300.0, math.radians(33.0), math.radians(25.0))
    behind = (camera.eye - 100.0 * camera.forward)[:, None]

    assert not Frustum(matrix).intersects_boxes(behind, np.full((3, 1), 10.0))[0]
