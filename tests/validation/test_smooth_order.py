"""Measured order of accuracy where the water is smooth: a simple wave, a vortex, and waves in a closed
basin with a hill.

The first two have exact solutions (Stoker 1957, section 10.5; Ricchiuto and Bollermann 2009, section 5.2).
The third has a bed and walls; it is compared with the same solver on a grid twice as fine as the finest,
averaged over the cells.
"""

import numpy as np

from tests.validation.pictures import Line, Panel
from tests.validation.runs import channel, l1, make_solver, order_of, solve, solve_published, square
from tests.validation.solutions import SimpleWave, StationaryVortex

WAVE = SimpleWave(h0=10.0, rise=0.05, width=200.0)
VORTEX = StationaryVortex(h0=10.0, peak=3.0, radius=200.0)
SIMPLE, SWIRL, BASIN = "Simple wave on a flat bed", "Vortex at rest", "Waves in a closed basin with a hill"


def wave_errors(cells, run=solve, **params):
    time = 0.5 * WAVE.breaking_time()
    grids = [channel(n, -1000.0, 3000.0) for n in cells]
    return [l1(run(WAVE, grid, time, **params)[0], WAVE.state(*grid.centres, time)[0]) for grid in grids]


def vortex_errors(cells, run=solve, **params):
    grids = [square(n, 2000.0) for n in cells]
    return [l1(run(VORTEX, grid, 60.0, **params)[0], VORTEX.state(*grid.centres, 0.0)[0]) for grid in grids]


def basin(cells, **params):
    """Depth in a walled square kilometre after a mound of water has spread over a submerged hill for 80 s."""
    grid = square(cells, 1000.0)
    x, y = grid.centres
    hill = 4.0 * np.exp(-((x - 150.0) ** 2 + (y + 100.0) ** 2) / 150.0**2)
    mound = 0.5 * np.exp(-((x + 200.0) ** 2 + (y - 100.0) ** 2) / 120.0**2)
    solver = make_solver(hill, grid.dx, **params)
    solver.set_water((10.0 + mound - hill).astype(np.float32))
    solver.advance_to(80.0)
    return solver.depth().astype(np.float64)


def convergence(title, cells, found, yardstick):
    """Errors against the number of cells, with the slope of second order."""
    second = yardstick[0] * (cells[0] / np.array(cells)) ** 2
    return Panel(
        title,
        "cells",
        "L1 of h [m]",
        (
            Line("exact", cells, second, "second order"),
            Line("other", cells[: len(yardstick)], yardstick),
            Line("computed", cells, found),
        ),
        log=True,
    )


def test_simple_wave_converges_with_second_order(figure, picture):
    cells = (160, 320, 640)
    found, yardstick = wave_errors(cells), wave_errors(cells, solve_published)
    picture(SIMPLE, "simple_wave", convergence("simple wave", cells, found, yardstick))
    rate = order_of(yardstick)
    figure(SIMPLE, "order of L1 of h, 320 to 640 cells", order_of(found), above=1.8, yardstick=rate)
    figure(
        SIMPLE,
        "L1 of h, 160 cells",
        found[0],
        unit="m",
        below=0.0021,
        yardstick=yardstick[0],
    )


def test_vortex_converges_with_second_order(figure, picture):
    cells = (64, 128, 256)
    found, yardstick = vortex_errors(cells), vortex_errors(cells[:2], solve_published)
    picture(SWIRL, "vortex", convergence("vortex", cells, found, yardstick))
    figure(SWIRL, "order of L1 of h, 128 to 256 cells a side", order_of(found), above=1.7)
    figure(
        SWIRL,
        "L1 of h, 64 cells a side",
        found[0],
        unit="m",
        below=0.00105,
        yardstick=yardstick[0],
    )


def test_waves_over_a_hill_between_walls_converge_with_second_order(figure):
    finest = basin(320)
    found = []
    for cells in (40, 80, 160):
        ratio = 320 // cells
        found.append(l1(basin(cells), finest.reshape(cells, ratio, cells, ratio).mean(axis=(1, 3))))
    figure(BASIN, "order of L1 of h, 40 to 80 cells a side", order_of(found[:2]), above=1.7)
    figure(BASIN, "L1 of h, 80 cells a side", found[1], unit="m", below=0.0006)


def test_first_order_run_shows_first_order(figure):
    found = wave_errors((320, 640), order=1)
    figure(SIMPLE, "order of L1 of h with params.order = 1 (control)", order_of(found), above=0.5, below=1.2)
    assert found[0] > 5.0 * wave_errors((320,))[0]
