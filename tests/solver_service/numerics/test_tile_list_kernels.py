"""Lists of active tiles made by thread blocks, against those made tile by tile."""

import numpy as np
import pytest
import warp as wp

from solver_service.numerics import FloodModel
from tests.solver_service.numerics.floods import bed, differences, solver


def a_wave_towards_a_dry_plain():
    """Water that moves, a lake at rest, dry land, and tiles that wake and fall asleep."""
    z = bed((64, 208), roughness=0.2)
    h = np.maximum(np.float32(3.0) - z, 0.0)
    h[:, 120:] = 0.0
    h[20:40, 2:10] += 0.5
    return FloodModel(10.0, z, 0.05), h


@pytest.mark.parametrize("lanes", [1, 256])
def test_the_same_tiles_are_active_and_the_same_bits_follow(lanes, monkeypatch):
    monkeypatch.setattr(wp.config, "enable_cpu_blocks", True)
    model, h = a_wave_towards_a_dry_plain()
    oracle, tiles = (solver(model, engine=engine) for engine in ("kernels", "tiles"))
    tiles._engine._lanes, tiles._engine._blocks = lanes, 4 if lanes > 1 else 1
    seen = []
    for s in (oracle, tiles):
        s.set_water(h)
    for time in (3.0, 9.0, 30.0, 31.0, 90.0):
        for s in (oracle, tiles):
            s.advance_to(time)
        assert np.array_equal(oracle._tiles.mask(), tiles._tiles.mask())
        assert differences(oracle, tiles) == []
        seen.append(int(tiles._tiles.mask().sum()))
    assert 0 < min(seen) < max(seen) < tiles._tiles.mask().size


def test_a_tile_that_falls_asleep_gets_the_same_state_in_both_buffers():
    z = np.zeros((48, 96), np.float32)
    awake = np.zeros(z.shape, bool)
    awake[20, 70] = True
    s = solver(FloodModel(5.0, z, 0.03), engine="tiles")
    s.set_water(np.full(z.shape, 5e-6, np.float32))  # a film that does not move
    s._tiles.keep_awake(awake)
    s.advance_to(1.0)
    assert s._tiles.mask()[1, 3:].all()
    s._tiles.keep_awake(np.zeros_like(awake))
    stale = s._store.arrays["h1"].numpy()
    stale[:] = 1.0
    s.advance_to(2.0)
    assert not s._tiles.mask().any()
    inside = stale[2:-2, 2:-2]
    assert (inside[:, 48:] == np.float32(5e-6)).all()
    assert (inside[:, :48] == 1.0).all()  # these slept before and were left alone


def test_nothing_is_listed_while_a_lake_is_at_rest():
    z = bed((64, 64))
    s = solver(FloodModel(10.0, z, 0.03), engine="tiles")
    s.set_water(np.maximum(np.float32(3.0) - z, 0.0))
    s.advance_to(200.0)
    assert s.active_cells == 0
    assert s.step_count >= 200.0 / s.dt
