"""The allocation table against what a solver really allocates."""

import gc

import numpy as np
import pytest
import warp as wp

from solver_service.numerics import (
    EdgeBoundary,
    FloodModel,
    Infiltration,
    Rain,
    ShallowWaterSolver,
    SolverParams,
)
from solver_service.numerics.allocation import MemoryOptions, allocation_table, device_bytes


def allocated(make):
    """What `make` returns, and the bytes of the Warp arrays that it has left behind."""
    gc.collect()
    before = {id(array) for array in gc.get_objects() if isinstance(array, wp.array)}
    made = make()
    gc.collect()
    arrays = [a for a in gc.get_objects() if isinstance(a, wp.array) and id(a) not in before]
    return made, sum(array.capacity for array in {array.ptr: array for array in arrays}.values())


def plain(shape):
    return FloodModel(5.0, np.zeros(shape, np.float32), np.full(shape, 0.03, np.float32)), SolverParams()


def with_everything(shape):
    z = np.zeros(shape, np.float32)
    zone = (np.arange(z.size).reshape(shape) % 2).astype(np.int32)
    model = FloodModel(
        5.0,
        z,
        0.03,
        boundaries=(EdgeBoundary("west", "open", 0, shape[0]),),
        rain=Rain.uniform(np.array([0.0, 9.0]), np.array([1e-5, 1e-5]), shape),
        infiltration=Infiltration("constant", zone, {"rate": np.array([1e-6, 2e-6])}),
        blocked=z > 1.0,
    )
    return model, SolverParams(arrival_depths=(0.1, 0.5))


@pytest.mark.parametrize("case", [plain, with_everything])
@pytest.mark.parametrize("engine", ["rows", "tiles"])
@pytest.mark.parametrize("shape", [(200, 300), (512, 512)])
def test_the_table_says_what_a_solver_allocates(case, engine, shape):
    model, params = case(shape)
    params = SolverParams(engine=engine, threads=2, arrival_depths=params.arrival_depths)
    _, nbytes = allocated(lambda: ShallowWaterSolver(model, params))
    device = "cpu" if engine == "rows" else "cuda:0"
    table = allocation_table(shape, MemoryOptions.of(model, params, threads=2), device)
    said = sum(line.nbytes for line in table if line.is_on_device)
    small = 60_000  # series, clocks and the like, which do not grow with the grid
    assert said <= nbytes <= said + small


def test_a_plain_run_takes_at_most_80_bytes_a_cell_with_the_copies_of_the_host():
    table = allocation_table((10_000, 10_000), MemoryOptions(roughness_raster=True, threads=64))
    assert device_bytes(table) <= 80 * 10_000**2


def test_100_million_cells_fit_a_card_of_24_gb_with_every_option():
    options = MemoryOptions(True, True, True, True, True, arrival_depths=4)
    assert device_bytes(allocation_table((10_000, 10_000), options, "cuda:0"), "cuda:0") < 24e9


def test_lines_add_up_per_cell_and_leave_out_what_is_not_asked_for():
    table = allocation_table((1000, 2000))
    assert {"rain", "infiltration", "roughness of the model"}.isdisjoint({line.name for line in table})
    for line in table:
        assert line.bytes_per_cell * 2_000_000 == pytest.approx(line.nbytes)
