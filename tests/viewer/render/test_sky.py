import numpy as np

from viewer.render.frame_uniforms import sun_direction
from viewer.render.sky import sky_faces


def test_faces_meet_without_a_seam() -> None:
    faces = sky_faces(sun_direction(315.0, 42.0), 64).astype(int)
    right, left, front, back = faces[0], faces[1], faces[4], faces[5]
    for one, other in ((front[:, -1], right[:, 0]), (right[:, -1], back[:, 0]), (back[:, -1], left[:, 0])):
        assert np.abs(one - other).mean() < 6.0


def test_the_sky_is_brightest_toward_the_sun() -> None:
    faces = sky_faces(sun_direction(90.0, 20.0), 64).astype(int)
    # +x is east; rows run downward, so the sun stands in the upper half of that face.
    brightness = faces.sum(axis=3)
    face, row, col = np.unravel_index(brightness.argmax(), brightness.shape)

    assert face == 0
    assert row < 32
    assert abs(col - 32) < 6


def test_the_sky_is_the_same_every_time() -> None:
    sun = sun_direction(10.0, 30.0)

    assert np.array_equal(sky_faces(sun, 32), sky_faces(sun, 32))
