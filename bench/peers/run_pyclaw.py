"""PyClaw on the common case: `python -m bench.peers.run_pyclaw CELLS FILE`.

Wave propagation of second order with transverse waves (MC limiter) and GeoClaw's augmented Riemann solver
(George 2008), which knows beds and dry cells; Manning friction after each step, implicit in the discharge
as GeoClaw has it. Arrays are [x, y].
"""

from __future__ import annotations

import logging
import sys
import time
from importlib.metadata import version

import numpy as np
from clawpack import pyclaw, riemann

from bench.peers import case

DEPTH_DRY = 1e-3
"""Water no deeper than this does not move [m]: GeoClaw's default."""


def slow(solver: object, state: pyclaw.State, dt: float) -> None:
    """Manning friction over `dt` [s]."""
    h, hu, hv = state.q
    wet = h > DEPTH_DRY
    depth = np.where(wet, h, 1.0)
    rate = case.GRAVITY * case.MANNING_N**2 * np.hypot(hu, hv) / depth ** (7.0 / 3.0)
    share = np.where(wet, 1.0 / (1.0 + dt * rate), 0.0)
    hu *= share
    hv *= share


def dry(solver: object, state: pyclaw.State) -> None:
    """Take negative depths as none and stop films, as GeoClaw does before each step."""
    np.maximum(state.q[0], 0.0, out=state.q[0])
    state.q[1:, state.q[0] < DEPTH_DRY] = 0.0


def main(cells: int, path: str) -> None:
    """Run and save."""
    solver = pyclaw.ClawSolver2D(riemann.sw_aug_2D)
    solver.fwave = True
    solver.limiters = pyclaw.limiters.tvd.MC
    solver.dimensional_split = False
    solver.transverse_waves = 2
    solver.before_step = dry
    solver.step_source, solver.source_split = slow, 1
    solver.cfl_max, solver.cfl_desired, solver.dt_initial = 1.0, 0.9, 1e-3
    for bounds in (solver.bc_lower, solver.bc_upper):
        bounds[0] = bounds[1] = pyclaw.BC.wall
    for bounds in (solver.aux_bc_lower, solver.aux_bc_upper):
        bounds[0] = bounds[1] = pyclaw.BC.extrap
    sides = [pyclaw.Dimension(0.0, case.SIDE, cells, name=name) for name in ("x", "y")]
    domain = pyclaw.Domain(sides)
    state = pyclaw.State(domain, 3, 1)
    state.problem_data["grav"] = case.GRAVITY
    x, y = case.centres(cells)
    state.aux[0] = case.bed(x, y).T
    state.q[0], state.q[1], state.q[2] = case.depth(x, y).T, 0.0, 0.0
    solution = pyclaw.Solution(state, domain)
    logging.getLogger("pyclaw").setLevel(logging.WARNING)
    solver.max_steps = 10**6
    before = float(state.q[0].sum())
    solver.setup(solution)
    cpu, wall = time.process_time(), time.perf_counter()
    status = solver.evolve_to_time(solution, case.END_TIME)
    seconds = time.process_time() - cpu, time.perf_counter() - wall
    q = solution.state.q
    volumes, steps = (before, float(q[0].sum())), status["numsteps"]
    case.save(path, (q[0].T, q[1].T, q[2].T), volumes, steps, seconds, version("clawpack"))


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2])
