"""Everything that only a machine with a GPU can tell, in one call: `python -m bench gpu`.

1. Do CPU and GPU agree? A flood with everything on, stepped by the row loops and by the GPU; the largest
   differences, and whether all bits are equal.
2. Is a run exact? The same GPU run in one piece and in two with a snapshot between, bit for bit.
3. How fast: fully wet and 20 % wet at 4096 x 4096, 5 % wet at 8192 x 8192, tiles against single cells, and
   what a step costs when there is next to nothing to do.
4. Does the host keep out of the way? Launches of the graph per interval when nobody may stop it, and how
   often it is asked when somebody may.

Without a GPU it says so and measures nothing.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

import numpy as np

from bench.floods import Water, lake_with_everything, wavy_lake
from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams, device_names
from solver_service.numerics.kernel_engine import KernelEngine

Line = dict[str, object]

Engine = Literal["auto", "tiles"]


def _line(figure: str, value: float, unit: str, case: str, floor: float | None = None) -> Line:
    return {"figure": figure, "value": value, "unit": unit, "floor": floor, "case": case}


def state_of(solver: ShallowWaterSolver) -> dict[str, np.ndarray]:
    """Everything that two runs must agree in."""
    arrays = dict(solver.snapshot().arrays)
    maxima = solver.maxima()
    return arrays | {"maxima_h": maxima.h, "clock": np.array([solver.time, solver.step_count])}


def begun(model: FloodModel, water: Water, params: SolverParams, device: str) -> ShallowWaterSolver:
    """A solver with water."""
    solver = ShallowWaterSolver(model, params, device)
    solver.set_water(*water)
    return solver


def agreement(device: str, side: int, engine: Engine = "auto") -> Iterator[Line]:
    """Differences between CPU and GPU, and between a run in one piece and in two."""
    model, water, params = lake_with_everything(side)
    case = f"{side} x {side}, everything on"
    here = begun(model, water, params, "cpu")
    there, split = (begun(model, water, replace(params, engine=engine), device) for _ in range(2))
    for solver in (here, there, split):
        solver.advance_to(10.0)
    kept = split.snapshot()
    split = begun(model, water, replace(params, engine=engine), device)
    split.restore(kept)
    for solver in (here, there, split):
        solver.advance_to(25.0)
    cpu, gpu, again = (state_of(solver) for solver in (here, there, split))
    for name in ("h", "u", "v"):
        difference = float(np.abs(cpu[name] - gpu[name]).max())
        yield _line(f"cpu_gpu_difference_{name}", difference, "m" if name == "h" else "m/s", case, 1e-4)
    unequal = [name for name in cpu if not np.array_equal(cpu[name], gpu[name], equal_nan=True)]
    yield _line("arrays_in_which_cpu_and_gpu_differ", len(unequal), "1", f"{case}: {', '.join(unequal)}", 0)
    unequal = [name for name in gpu if not np.array_equal(gpu[name], again[name], equal_nan=True)]
    yield _line("arrays_that_a_split_run_changes", len(unequal), "1", f"{case}: {', '.join(unequal)}", 0)


def steps_per_second(solver: ShallowWaterSolver, interval: float) -> float:
    """Best of three intervals, after one to warm up."""
    solver.advance_to(solver.time + interval)
    best = 0.0
    for _ in range(3):
        steps, began = solver.step_count, time.perf_counter()
        solver.advance_to(solver.time + interval)
        best = max(best, (solver.step_count - steps) / (time.perf_counter() - began))
    return best


def rates(device: str, side: int) -> Iterator[Line]:
    """Cell-steps per second, all cells of the grid counted."""
    case = f"{side} x {side}"
    wet: dict[float, float] = {}
    for part, floor in ((1.0, 15e9), (0.2, 100e9)):
        solver = begun(*wavy_lake(side, part), SolverParams(), device)
        wet[part] = side * side * steps_per_second(solver, 60.0)
        yield _line(f"rate_{part:.0%}_wet", wet[part], "cell-steps/s", case, floor)
    for engine in ("tiles", "kernels"):
        solver = begun(*wavy_lake(side), SolverParams(engine=engine), device)
        yield _line(f"rate_{engine}", side * side * steps_per_second(solver, 20.0), "cell-steps/s", case)
    model, water, params = lake_with_everything(side)
    solver = begun(model, water, params, device)
    yield _line("rate_everything_on", side * side * steps_per_second(solver, 20.0), "cell-steps/s", case)
    double = 2 * side
    solver = begun(*wavy_lake(double, 0.05), SolverParams(), device)
    seconds = 1.0 / steps_per_second(solver, 60.0)
    case = f"{double} x {double}, 5 % wet"
    yield _line("step_at_5_percent_wet", 1e6 * seconds, "us", case, 60.0)
    cost = seconds * wet[1.0] / double**2
    yield _line("cost_at_5_percent_wet", cost, "1", case, 0.08)
    solver = begun(*wavy_lake(64), SolverParams(), device)
    yield _line("overhead_per_step", 1e6 / steps_per_second(solver, 600.0), "us", "64 x 64", 60.0)


def waiting(device: str, side: int, engine: Engine = "auto") -> Iterator[Line]:
    """How often the host launches the graph in an interval, and how long it waits between questions."""
    solver = begun(*wavy_lake(side), SolverParams(engine=engine), device)
    solver.advance_to(30.0)
    stepper = solver._engine
    assert isinstance(stepper, KernelEngine)
    launches = 0
    launch = stepper._launch_steps

    def counted(limit: int) -> None:
        nonlocal launches
        launches += 1
        launch(limit)

    stepper._launch_steps = counted  # type: ignore[method-assign]
    solver.advance_to(90.0)
    yield _line("graph_launches_per_interval", launches, "1", f"{side} x {side}, 60 s", 1)
    launches, began, asked = 0, time.perf_counter(), [time.perf_counter()]
    solver.advance_to(150.0, should_stop=lambda: asked.append(time.perf_counter()) is not None)
    gaps = np.diff(asked)
    yield _line("longest_wait_for_a_question", float(gaps.max()), "s", f"{side} x {side}", 0.25)
    yield _line(
        "wall_time_of_an_interval_with_questions", time.perf_counter() - began, "s", f"{launches} launches"
    )


def figures(smoke: bool) -> Iterator[Line]:
    """All figures of the first GPU; one line that says so where there is none."""
    devices = device_names()[1:]
    if not devices:
        yield _line("gpus", 0, "1", "no CUDA device here: nothing measured")
        return
    device, side = devices[0], 512 if smoke else 4096
    yield _line("gpus", len(devices), "1", device)
    yield from agreement(device, 512)
    yield from rates(device, side)
    yield from waiting(device, side)
