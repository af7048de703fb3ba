import math

import numpy as np
import pytest

from viewer.render import Unprojection, march_ray
from viewer.world import Camera, Heightfield

CAMERA = Camera((100.0, 20.0, 50.0), 900.0, 0.7, 0.5)


def test_unprojection_undoes_projection(hilly: Heightfield, rng: np.random.Generator) -> None:
    matrix = CAMERA.projection(1.6, 10.0, 5000.0) @ CAMERA.view_matrix()
    back = Unprojection(np.linalg.inv(matrix), (640, 400), hilly.frame)
    points = np.array(CAMERA.target) + rng.uniform(-100.0, 100.0, (50, 3))
    clip = np.column_stack([points, np.ones(50)]) @ matrix.T
    ndc = clip[:, :3] / clip[:, 3:]
    column, row = (ndc[:, 0] + 1.0) * 320.0 - 0.5, (ndc[:, 1] + 1.0) * 200.0 - 0.5

    assert back.world(column, row, 0.5 * (ndc[:, 2] + 1.0)) == pytest.approx(points, abs=1e-6)


@pytest.mark.parametrize("exaggeration", [1.0, 3.0])
def test_a_ray_ends_on_the_ground_in_its_own_direction(hilly: Heightfield, exaggeration: float) -> None:
    frame = hilly.frame.exaggerated(exaggeration)
    for x, y in ((0.0, 0.0), (0.6, -0.5), (-0.8, 0.1)):
        place = march_ray(CAMERA, x, y, 1.6, hilly, frame)
        assert place is not None
        assert place[2] == pytest.approx(hilly.sample(place[0], place[1]), abs=0.02)
        toward = np.array(frame.to_world(*place)) - CAMERA.eye
        assert toward / np.linalg.norm(toward) == pytest.approx(CAMERA.ray(x, y, 1.6), abs=1e-6)


def test_the_first_hill_in_the_way_stops_the_ray(hilly: Heightfield) -> None:
    wall = hilly.z_b.copy()
    wall[:, 150] += 400.0
    hilly.set(wall)
    camera = Camera((1000.0, 100.0, 0.0), 1900.0, math.pi / 2, 0.1)
    place = march_ray(camera, 0.0, 0.0, 1.6, hilly, hilly.frame)

    assert place is not None
    assert abs(place[0] - hilly.grid.center(0, 150)[0]) < hilly.grid.dx


def test_a_ray_into_the_sky_or_past_the_map_ends_nowhere(hilly: Heightfield) -> None:
    low = Camera((0.0, 50.0, 0.0), 500.0, 0.0, 0.1)

    assert march_ray(low, 0.0, 0.95, 1.6, hilly, hilly.frame) is None
    away = Camera((0.0, 50.0, 0.0), 9000.0, 0.0, 0.1)
    assert march_ray(away, 0.99, 0.0, 1.6, hilly, hilly.frame) is None
