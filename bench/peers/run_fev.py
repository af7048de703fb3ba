"""FEV on the common case: `python -m bench.peers.run_fev CELLS FILE [THREADS or cuda:N]`."""

from __future__ import annotations

import sys
import time
from importlib.metadata import version

import numpy as np

from bench.peers import case
from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams


def main(cells: int, path: str, threads: str = "1") -> None:
    """Run and save."""
    device = threads if threads.startswith("cuda") else "cpu"
    x, y = case.centres(cells)
    model = FloodModel(case.SIDE / cells, case.bed(x, y).astype(np.float32), case.MANNING_N)
    # The peers know no eddy viscosity: the same equations for all.
    params = SolverParams(threads=int(threads) if device == "cpu" else None, eddy_viscosity=0.0)
    solver = ShallowWaterSolver(model, params, device)
    solver.set_water(case.depth(x, y))
    solver.advance_to(1e-3)  # what is compiled or captured at the first step is not the time loop
    cpu, wall, before = time.process_time(), time.perf_counter(), solver.step_count
    solver.advance_to(case.END_TIME)
    seconds = time.process_time() - cpu, time.perf_counter() - wall
    h, u, v = (q.astype(np.float64) for q in (solver.depth(), *solver.velocity()))
    budget, steps = solver.budget(), solver.step_count - before
    volumes = budget.initial, budget.stored
    case.save(path, (h, h * u, h * v), volumes, steps, seconds, version("flood-emergency-visualizer"))


if __name__ == "__main__":
    main(int(sys.argv[1]), *sys.argv[2:])
