"""The tile step of GPUs, run on the CPU: one lane, and all 256 of them with real barriers."""

import numpy as np
import pytest
import warp as wp

from solver_service.numerics import FloodModel
from solver_service.numerics import tile_step_kernels as tile_step
from solver_service.numerics.fields import Fields, FieldStore, Scheme
from solver_service.numerics.step_kernels import step_cell
from solver_service.numerics.warp_modules import STEP_MODULE
from tests.solver_service.numerics.floods import GAUGES, bed, differences, full_model, solver, wild_water

TIMES = (1.3, 6.0, 11.0)


def run(model, water, lanes=None, blocks=1, **params):
    s = solver(model, gauges=GAUGES, gauge_interval=0.35, **params)
    if lanes is not None:
        s._engine._lanes, s._engine._blocks = lanes, blocks
    s.set_water(*water)
    for time in TIMES:
        s.advance_to(time)
    return s


@pytest.fixture
def cpu_blocks(monkeypatch):
    """Lanes of a block as fibers that switch at barriers."""
    monkeypatch.setattr(wp.config, "enable_cpu_blocks", True)


@pytest.mark.parametrize("scheme", [{}, {"order": 1}, {"riemann": "hll"}, {"limiter_theta": 1.0}])
def test_tiles_equal_the_cell_by_cell_kernel_bit_for_bit(scheme):
    model = full_model()
    water = wild_water(model.z_b)
    oracle = run(model, water, engine="kernels", **scheme)
    assert differences(oracle, run(model, water, engine="tiles", **scheme)) == []
    assert oracle.step_count > 20


@pytest.mark.parametrize("shape", [(5, 9), (16, 16), (33, 64), (40, 100)])
def test_any_grid_gives_the_same_bits_whether_its_rows_are_aligned_or_not(shape):
    z = bed(shape, roughness=0.2)
    water = (np.maximum(np.float32(1.0) - z, 0.0), np.full(shape, 0.3, np.float32))
    oracle, tiles = (solver(FloodModel(2.0, z, 0.03), engine=engine) for engine in ("kernels", "tiles"))
    for s in (oracle, tiles):
        s.set_water(*water)
        s.advance_to(4.0)
    assert differences(oracle, tiles) == []


def test_256_lanes_and_several_blocks_give_the_same_bits(cpu_blocks):
    model = full_model(rain=False)
    water = wild_water(model.z_b)
    one = run(model, water, engine="tiles")
    assert differences(one, run(model, water, engine="tiles", lanes=256, blocks=3)) == []


@wp.func_native(tile_step.with_names(tile_step.STEP_SOURCE).replace("WP_TILE_SYNC();", ""))
def step_tile_hastily(
    f: Fields,
    s: Scheme,
    tile: int,
    tile_cols: int,
    dt: float,
    stable: float,
    time: float,
    host_memory: wp.array(dtype=wp.float32),
    wave_slots: wp.array(dtype=wp.float32),
):
    """`step_tile`, but no phase waits for the one before."""
    ...


@wp.kernel(module=wp.get_module("tests.tile_step"))
def step_one_tile(
    f: Fields,
    s: Scheme,
    hastily: int,
    host_memory: wp.array(dtype=wp.float32),
    wave_slots: wp.array(dtype=wp.float32),
):
    if tile_step.never():
        step_cell(f, s, 2, 2, 0.2, 0.2, 1.0)
    if hastily == 1:
        step_tile_hastily(f, s, 0, 1, 0.2, 0.2, 1.0, host_memory, wave_slots)
    else:
        tile_step.step_tile(f, s, 0, 1, 0.2, 0.2, 1.0, host_memory, wave_slots)


step_one_tile.module.options.update(STEP_MODULE.options)


def depths_after_one_step(lanes, hastily):
    """Depths of a small wild lake after one step of its one tile."""
    z = bed((16, 16))
    store = FieldStore(16, 16, "cpu")
    store.write_padded("z", np.pad(z, 2, mode="symmetric"))
    store.write("h", 2.0 + np.random.default_rng(5).random(z.shape).astype(np.float32))
    scheme = Scheme()
    scheme.dx, scheme.theta, scheme.hancock, scheme.contact = 5.0, 1.5, 1.0, 1.0
    scheme.depth_dry, scheme.depth_film, scheme.depth_arrival = 1e-3, 1e-5, 0.01
    scheme.nrows, scheme.ncols = z.shape
    memory = wp.zeros(tile_step.HOST_MEMORY, dtype=wp.float32, device="cpu")
    waves = wp.zeros(1, dtype=wp.float32, device="cpu")
    inputs = [store.fields[0], scheme, int(hastily), memory, waves]
    wp.launch(step_one_tile, dim=lanes, inputs=inputs, device="cpu", block_dim=lanes)
    store.parity = 1
    return store.read("h")


def test_the_barriers_between_the_phases_are_needed(cpu_blocks):
    one_lane = depths_after_one_step(1, hastily=False)
    assert np.array_equal(depths_after_one_step(256, hastily=False), one_lane)
    assert not np.array_equal(depths_after_one_step(256, hastily=True), one_lane)
