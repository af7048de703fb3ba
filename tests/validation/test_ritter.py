"""Dam break on a dry bed (Ritter 1892; SWASHES section 4.1.2): 10 m of water, 200 cells of 10 m, 40 s."""

import numpy as np
import pytest

from tests.validation.pictures import profiles
from tests.validation.runs import channel, errors, l1, order_of, solve, solve_published
from tests.validation.solutions import Ritter

CASE = "Ritter: dam break on a dry bed, 200 cells"
DAM = Ritter(h_left=10.0)
GRID = channel(200, -1000.0, 1000.0)
TIME = 40.0
BOUNDS = {
    "L1 of h": 0.0175,
    "L2 of h": 0.031,
    "Linf of h": 0.172,
    "L1 of the unit discharge": 0.165,
    "L1 of the velocity": 0.036,
}


@pytest.fixture(scope="module")
def computed():
    return solve(DAM, GRID, TIME)


def exact(grid=GRID):
    return DAM.state(*grid.centres, TIME)


@pytest.fixture(scope="module")
def published():
    return solve_published(DAM, GRID, TIME)


def test_errors_stay_below_the_published_second_order_scheme(computed, published, compare, picture):
    compare(CASE, BOUNDS, computed, exact(), published)
    near = GRID.centres[0][0] > -500.0
    states = (tuple(q[0][near] for q in state) for state in (exact(), computed, published))
    picture(CASE, "ritter", *profiles(GRID.centres[0][0][near], *states))


def test_first_order_run_fails_the_bounds():
    first = errors(solve(DAM, GRID, TIME, order=1), exact())
    assert all(first[norm] > 1.5 * bound for norm, bound in BOUNDS.items())


def test_front_is_never_ahead_of_the_exact_one_and_lags_no_more_than_the_published(
    computed, published, figure
):
    x = GRID.centres[0][0]
    reach, front, yardstick = (x[state[0][0] > 0.01].max() for state in (exact(), computed, published))
    figure(
        CASE,
        "front (h = 1 cm) behind the exact one",
        reach - front,
        unit="m",
        below=reach - yardstick,
        above=-10.0,
        yardstick=reach - yardstick,
    )


def test_error_falls_with_the_cell(figure):
    finer = [channel(cells, -1000.0, 1000.0) for cells in (200, 400, 800)]
    found = [l1(solve(DAM, grid, TIME)[0], exact(grid)[0]) for grid in finer]
    figure(
        CASE, "order of L1 of h, 400 to 800 cells (corners of the fan limit it)", order_of(found), above=0.8
    )


def test_water_does_not_depend_on_the_row(computed):
    assert all(np.ptp(q, axis=0).max() == 0.0 for q in computed)
