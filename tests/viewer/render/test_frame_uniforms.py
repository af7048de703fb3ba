import pytest

from viewer.render.frame_uniforms import sun_direction


@pytest.mark.parametrize(
    ("azimuth", "elevation", "expected"),
    [
        (0.0, 0.0, (0.0, 0.0, -1.0)),
        (90.0, 0.0, (1.0, 0.0, 0.0)),
        (180.0, 0.0, (0.0, 0.0, 1.0)),
        (45.0, 90.0, (0.0, 1.0, 0.0)),
    ],
)
def test_the_sun_stands_at_its_compass_bearing(azimuth: float, elevation: float, expected: tuple) -> None:
    assert sun_direction(azimuth, elevation) == pytest.approx(expected, abs=1e-12)
