import numpy as np
import pytest

from tests.viewer.conftest import hills
from viewer.world.apron import continued


def island(rows: int, cols: int) -> np.ndarray:
    """Cells outside of a disk."""
    r, c = np.meshgrid(np.linspace(-1, 1, rows), np.linspace(-1, 1, cols), indexing="ij")
    return np.hypot(r, c) > 0.6


@pytest.mark.parametrize("shape", [(65, 65), (100, 37), (2, 9)])
def test_data_is_kept_bit_for_bit_and_the_wall_is_gone(shape: tuple[int, int]) -> None:
    z = hills(*shape, 10.0, 20.0)
    outside = island(*shape)
    outside[0, 0] = True
    outside[-1, -1] = False
    walled = np.where(outside, np.float32(500.0), z)
    drawn = continued(walled, outside)

    assert np.array_equal(drawn[~outside], z[~outside])
    assert drawn.max() <= z[~outside].max()
    assert drawn.min() >= z[~outside].min()


def test_the_ground_goes_on_without_a_step() -> None:
    z = hills(129, 129, 10.0, 20.0)
    outside = island(129, 129)
    drawn = continued(np.where(outside, np.float32(500.0), z), outside)
    for axis in (0, 1):
        steps = np.abs(np.diff(drawn, axis=axis))
        assert steps.max() < 2.0 * np.abs(np.diff(z, axis=axis)).max()


def test_ground_with_data_everywhere_or_nowhere_is_no_trouble() -> None:
    z = hills(20, 30, 10.0, 20.0)
    assert np.array_equal(continued(z, np.zeros(z.shape, np.bool_)), z)
    assert not continued(z, np.ones(z.shape, np.bool_)).any()
