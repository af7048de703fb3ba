"""Surface that swells and sinks in a paraboloid (Thacker 1981; SWASHES section 4.2.2), third oscillation,
moving shore."""

import numpy as np
import pytest

from tests.validation.runs import errors, l1, order_of, solve, solve_published, square
from tests.validation.shores import energy, shore_mismatch
from tests.validation.solutions import ThackerRadial

CASE = "Thacker: curved surface in a paraboloid, 80 x 80 cells, 2.25 oscillations"
BOWL = ThackerRadial(a=1000.0, h0=10.0, r0=800.0)
GRID = square(80, 3000.0)
TIME = 2.25 * BOWL.period
BOUNDS = {
    "L1 of h": 0.0258,
    "L2 of h": 0.0625,
    "Linf of h": 0.362,
    "L1 of the unit discharge": 0.335,
    "L1 of the velocity": 0.23,
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


def test_wrong_solution_fails_the_bounds(computed):
    wrong = ThackerRadial(a=1000.0, h0=10.0, r0=780.0).state(*GRID.centres, TIME)
    assert errors(computed, wrong)["L1 of h"] > BOUNDS["L1 of h"]


def test_shore_is_found_within_a_fraction_of_a_cell(computed, figure):
    perimeter = 2.0 * np.pi * BOWL.shore(TIME)
    off = shore_mismatch(computed[0], exact()[0], 0.01 * BOWL.h0, GRID.dx, perimeter)
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
        above=0.865,
        below=1.001,
        yardstick=motion_left(published),
    )


def test_error_falls_faster_than_the_cell_although_the_shore_moves(figure):
    found = [l1(solve(BOWL, grid, TIME)[0], exact(grid)[0]) for grid in (GRID, square(160, 3000.0))]
    figure(CASE, "order of L1 of h, 80 to 160 cells a side", order_of(found), above=1.2)


def test_round_basin_keeps_its_eight_symmetries(computed, figure):
    h = computed[0]
    mirrored = (h[::-1], h[:, ::-1], h.T, h[::-1, ::-1])
    off = max(np.abs(h - other).max() for other in mirrored)
    figure(CASE, "largest difference between mirror images", off, unit="m", below=0.0)
