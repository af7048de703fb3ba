"""The cube root and the friction law."""

import numpy as np
import warp as wp

from solver_service.numerics.friction import friction_factor, inverse_cube_root


@wp.kernel(enable_backward=False)
def evaluate(
    x: wp.array(dtype=wp.float32), root: wp.array(dtype=wp.float32), factor: wp.array(dtype=wp.float32)
):
    k = wp.tid()
    root[k] = inverse_cube_root(x[k])
    factor[k] = friction_factor(x[k], 2.0, 0.0088, 3.0)


def test_inverse_cube_root_and_friction_reach_float32_accuracy():
    x = np.geomspace(1e-6, 1e3, 4001).astype(np.float32)
    arrays = [wp.array(x, dtype=wp.float32, device="cpu")] + [
        wp.zeros(x.size, dtype=wp.float32, device="cpu") for _ in "ab"
    ]
    wp.launch(evaluate, dim=x.size, inputs=arrays, device="cpu")
    exact = x.astype(np.float64)
    assert abs(arrays[1].numpy() * exact ** (1 / 3) - 1.0).max() < 5e-7
    k = 0.0088 * exact ** (-4 / 3)
    after = 2.0 * arrays[2].numpy().astype(np.float64)
    assert (abs(after + 3.0 * k * after * after - 2.0) / 2.0).max() < 2e-6
