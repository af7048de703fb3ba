"""What a solver step costs: cells per second, threads, dry land, Python per step, compiling, Malpasset.

Rates count every cell of the grid and the whole step: time step, maxima, arrival time and a roughness
raster. A floor is what the design asks for: at least for rates, at most for costs and errors.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from multiprocessing import get_context
from pathlib import Path
from typing import Literal

import numpy as np

from bench.floods import lake_with_everything, wavy_lake
from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams, device_names

Engine = Literal["auto", "rows", "kernels"]

MALPASSET_SECONDS = 4000.0


@dataclass(frozen=True)
class Figure:
    """One measured number."""

    figure: str
    value: float
    unit: str
    floor: float | None
    case: str


def seconds_per_step(solver: ShallowWaterSolver, interval: float, repeats: int) -> float:
    """Best of several intervals [s], after one to warm up."""
    solver.advance_to(solver.time + interval)
    best = float("inf")
    for _ in range(repeats):
        steps, began = solver.step_count, time.perf_counter()
        solver.advance_to(solver.time + interval)
        best = min(best, (time.perf_counter() - began) / (solver.step_count - steps))
    return best


def wet_rate(side: int, threads: int, device: str = "cpu", engine: Engine = "auto") -> float:
    """Cell-steps per second of a fully wet grid."""
    model, water = wavy_lake(side)
    solver = ShallowWaterSolver(model, SolverParams(threads=threads, engine=engine), device)
    solver.set_water(*water)
    return side * side / seconds_per_step(solver, 6.0, 4)


def fully_wet(smoke: bool) -> Iterator[Figure]:
    """Rates of a fully wet grid: one thread, all threads, independent processes, scalar kernels, GPUs."""
    side = 256 if smoke else 1024
    case = f"{side} x {side}, all wet"
    floor = None if smoke else 35e6
    yield Figure("wet_one_thread", wet_rate(side, 1), "cell-steps/s", floor, case)
    threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    together = wet_rate(side, threads)
    yield Figure(f"wet_{threads}_threads", together, "cell-steps/s", None, case)
    if not smoke:
        with ProcessPoolExecutor(threads, mp_context=get_context("spawn")) as pool:
            apart = sum(pool.map(wet_rate, [side] * threads, [1] * threads))
        yield Figure("threads_to_processes", together / apart, "1", 0.95, case)
    small = side // 4
    yield Figure(
        "wet_scalar", wet_rate(small, 1, engine="kernels"), "cell-steps/s", None, f"{small} x {small}"
    )
    for device in device_names()[1:]:
        side = 1024 if smoke else 4096
        rate = wet_rate(side, 1, device)
        yield Figure(
            f"wet_{device}", rate, "cell-steps/s", None if smoke else 15e9, f"{side} x {side}, all wet"
        )


def everything_on(smoke: bool) -> Iterator[Figure]:
    """Rate of a fully wet grid with rain, infiltration, sources, driven edges, gauges and depth classes."""
    side = 256 if smoke else 1024
    model, water, params = lake_with_everything(side)
    solver = ShallowWaterSolver(model, replace(params, threads=1))
    solver.set_water(*water)
    rate = side * side / seconds_per_step(solver, 6.0, 4)
    yield Figure("wet_one_thread_everything_on", rate, "cell-steps/s", None, f"{side} x {side}, all wet")


def mostly_dry(smoke: bool) -> Iterator[Figure]:
    """Cost of a step with 5 % wet columns in units of a fully wet one."""
    for side in (640,) if smoke else (2048, 8192):
        costs = []
        for wet in (0.05, 1.0):
            model, water = wavy_lake(side, wet)
            solver = ShallowWaterSolver(model, SolverParams(threads=1))
            solver.set_water(*water)
            costs.append(seconds_per_step(solver, 20.0 if side == 2048 else 6.0, 3 if side < 8192 else 1))
            del solver
        floor = None if smoke else 0.08
        yield Figure("cost_at_5_percent_wet", costs[0] / costs[1], "1", floor, f"{side} x {side}")


def per_step(smoke: bool) -> Iterator[Figure]:
    """What a step costs beside its cells: one tile, moving."""
    model, water = wavy_lake(16)
    solver = ShallowWaterSolver(model, SolverParams(threads=1))
    solver.set_water(*water)
    cost = seconds_per_step(solver, 200.0 if smoke else 2000.0, 3)
    yield Figure("overhead_per_step", 1e6 * cost, "us", 100.0, "16 x 16")


def compiling(smoke: bool) -> Iterator[Figure]:
    """Seconds to compile the kernels of a CPU run into an empty cache."""
    if smoke:
        return
    code = "from solver_service.numerics import warm_kernels; print(warm_kernels('cpu'))"
    with tempfile.TemporaryDirectory() as cache:
        out = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "WARP_CACHE_PATH": cache},
            check=True,
            capture_output=True,
            text=True,
        ).stdout
    yield Figure("cold_compile", float(out.split()[-1]), "s", 25.0, "row engine")


def malpasset(smoke: bool) -> Iterator[Figure]:
    """The 1959 dam break on the 15 m raster, all threads; needs `FEV_DATA_HOME`."""
    home = os.environ.get("FEV_DATA_HOME")
    file = Path(home or ".") / "malpasset" / "malpasset_15m.npz"
    if smoke or not file.is_file():
        return
    data = np.load(file)
    solver = ShallowWaterSolver(FloodModel(15.0, data["bed"][::-1], 1.0 / 30.0))
    solver.set_water(data["depth0"][::-1])
    began = time.perf_counter()
    for k in range(1, 201):
        solver.advance_to(k * MALPASSET_SECONDS / 200)
    wall = time.perf_counter() - began
    case = f"Malpasset 15 m, {solver.step_count} steps"
    yield Figure("malpasset_real_time_factor", MALPASSET_SECONDS / wall, "1", 20.0, case)
    yield Figure("malpasset_volume_error", abs(solver.budget().error_relative), "1", 1e-6, case)


GROUPS = (fully_wet, everything_on, mostly_dry, per_step, compiling, malpasset)


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Every figure of every group."""
    for group in GROUPS:
        for figure in group(smoke):
            yield asdict(figure)
