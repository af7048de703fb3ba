"""The device quantises and classifies exactly as the protocol does."""

import numpy as np
import pytest

from protocol import BlockLayout, quantise_depth
from solver_service.numerics import FloodModel
from tests.solver_service.numerics.floods import solver


@pytest.mark.parametrize("shape", [(2, 2), (33, 33), (34, 65), (70, 90), (97, 32)])
@pytest.mark.parametrize(("scale", "depth_wet"), [(0.001, 0.001), (0.002, 0.01), (0.05, 0.001)])
def test_device_and_protocol_agree_bit_for_bit(shape, scale, depth_wet, rng):
    h = rng.choice([0.0, 1e-4, depth_wet, 0.5 * scale, 1.5 * scale, 2.5 * scale, 70.0, 200.0], shape)
    h = (h + rng.random(shape) * rng.choice([0.0, 1.0], shape)).astype(np.float32)
    h[: shape[0] // 2, : shape[1] // 2] = 0.0
    s = solver(FloodModel(5.0, np.zeros(shape, np.float32), 0.03), threads=1)
    s.set_water(h)
    q, states = s.quantise(scale, depth_wet)
    expected = quantise_depth(h, scale, depth_wet)
    assert np.array_equal(q, expected)
    assert q.dtype == expected.dtype
    assert np.array_equal(states, BlockLayout(*shape).classify(expected))
