"""Plane surface that circles in a paraboloid (Thacker 1981; SWASHES section 4.2.2), third revolution,
moving shore."""

import numpy as np
import pytest

from tests.validation.runs import errors, l1, order_of, solve, solve_published, square
from tests.validation.shores import energy, shore_mismatch
from tests.validation.solutions import ThackerPlanar

CASE = "Thacker: plane surface in a paraboloid, 80 x 80 cells, 2.25 revolutions"
BOWL = ThackerPlanar(a=1000.0, h0=10.0, sigma=500.0)
GRID = square(80, 4000.0)
TIME = 2.25 * BOWL.period
BOUNDS = {
    "L1 of h": 0.024,
    "L2 of h": 0.071,
    "Linf of h": 0.75,
    "L1 of the unit discharge": 0.38,
    "L1 of the velocity": 0.315,
}


@pytest.fixture(scope="module")
def computed():
    return solve(BOWL, GRID, TIME)


@pytest.fixture(scope="module")
def published():
    return solve_published(BOWL, GRID, TIME)


def exact(grid=GRID):
    return BOWL.state(*grid.centres, TIME)


def test_errors_stay_below_the_published_second_order_scheme(computed, published, compare):
    compare(CASE, BOUNDS, computed, exact(), published)


def test_first_order_run_fails_the_bounds():
    first = errors(solve(BOWL, GRID, TIME, order=1), exact())
    assert all(
        first[norm] > 3.0 * BOUNDS[norm] for norm in ("L1 of h", "L2 of h", "L1 of the unit discharge")
    )


def test_shore_is_found_within_a_fraction_of_a_cell(computed, figure):
    off = shore_mismatch(computed[0], exact()[0], 0.01 * BOWL.h0, GRID.dx, 2.0 * np.pi * BOWL.a)
    figure(CASE, "mean distance of the shore (h = 0.1 m)", off, unit="cells", below=0.5)


def motion_left(state):
    """Energy of the motion in units of that at the start."""
    bed = BOWL.bed(*GRID.centres)
    rest = energy((np.maximum(-bed, 0.0), 0.0 * bed, 0.0 * bed), bed)
    return (energy(state, bed) - rest) / (energy(BOWL.state(*GRID.centres, 0.0), bed) - rest)


def test_energy_of_the_motion_hardly_decays(computed, published, figure):
    kept = motion_left(computed)
    figure(
        CASE,
        "energy of the motion that is left",
        kept,
        above=0.96,
        below=1.001,
        yardstick=motion_left(published),
    )


def test_error_falls_faster_than_the_cell_although_the_shore_moves(figure):
    found = [l1(solve(BOWL, grid, TIME)[0], exact(grid)[0]) for grid in (GRID, square(160, 4000.0))]
    figure(CASE, "order of L1 of h, 80 to 160 cells a side", order_of(found), above=1.2)
