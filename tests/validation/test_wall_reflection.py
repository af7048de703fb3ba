"""Water that runs into a wall (Stoker 1957, section 10.7; Toro 2001, section 5.3): the edge, a cliff,
blocked cells.

A stream of 2 m and 5 m/s meets a wall; a bore goes back. At the edge of the grid the wall is a mirror; a
cliff of the bed and blocked cells must act alike, although the scheme sees nothing but a step there.
"""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams
from tests.validation.runs import channel, l1
from tests.validation.solutions import WallReflection

CASE = "Bore reflected by a wall, cells of 5 m"
STREAM = WallReflection(depth=2.0, speed=5.0)
WEST, TIME = -1000.0, 30.0
EAST = {"edge of the grid": 0.0, "cliff of 40 m": 100.0, "blocked cells": 100.0}


def run(wall, **params):
    """Depth and its exact value between the wall and where the western edge is felt."""
    grid = channel(int((EAST[wall] - WEST) / 5.0), WEST, EAST[wall])
    x, y = grid.centres
    beyond = x > 0.0
    bed = np.where(beyond & (wall == "cliff of 40 m"), np.float32(40.0), np.float32(0.0))
    model = FloodModel(
        dx=grid.dx, z_b=bed, manning_n=0.0, blocked=beyond if wall == "blocked cells" else None
    )
    solver = ShallowWaterSolver(model, SolverParams(**params), device="cpu")
    solver.set_water(*(q.astype(np.float32) for q in STREAM.state(x, y, 0.0)))
    solver.advance_to(TIME)
    clear = (x > WEST + 12.0 * TIME) & ~beyond
    assert not solver.depth()[beyond].any()
    return solver.depth()[clear], STREAM.state(x, y, TIME)[0][clear], x[clear]


@pytest.mark.parametrize("wall", EAST)
def test_reflected_bore_has_the_exact_depth_and_place(wall, figure):
    depth, exact, x = run(wall)
    figure(CASE, f"L1 of h, {wall}", l1(depth, exact), unit="m", below=0.013)
    h2, back = STREAM.reflected
    still = (x > -0.8 * back * TIME) & (x < -20.0)
    figure(
        CASE,
        f"largest error of the depth behind the bore, {wall}",
        np.abs(depth[still] - h2).max(),
        unit="m",
        below=0.005,
    )


def test_first_order_run_fails_the_bounds():
    depth, exact, _ = run("edge of the grid", order=1)
    assert l1(depth, exact) > 1.3 * 0.013
