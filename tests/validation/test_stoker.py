"""Dam break on a wet bed (Stoker 1957; SWASHES section 4.1.1): 10 m against 1 m, cells of 10 m."""

import numpy as np
import pytest

from tests.validation.pictures import profiles
from tests.validation.runs import channel, errors, l1, solve, solve_published
from tests.validation.solutions import Stoker

CASE = "Stoker: dam break on a wet bed, 200 cells"
DAM = Stoker(h_left=10.0, h_right=1.0)
GRID = channel(200, -1000.0, 1000.0)
TIME = 40.0
BOUNDS = {
    "L1 of h": 0.0185,
    "L2 of h": 0.081,
    "Linf of h": 0.99,
    "L1 of the unit discharge": 0.113,
    "L1 of the velocity": 0.0365,
}


@pytest.fixture(scope="module")
def computed():
    return solve(DAM, GRID, TIME)


def exact():
    return DAM.state(*GRID.centres, TIME)


def test_errors_stay_below_the_published_second_order_scheme(computed, compare, picture):
    published = solve_published(DAM, GRID, TIME)
    compare(CASE, BOUNDS, computed, exact(), published)
    near = np.abs(GRID.centres[0][0]) < 500.0
    states = (tuple(q[0][near] for q in state) for state in (exact(), computed, published))
    picture(CASE, "stoker", *profiles(GRID.centres[0][0][near], *states))


def test_relative_error_is_far_below_what_a_second_order_peer_asserts(computed, figure):
    relative = l1(computed[0], exact()[0]) / exact()[0].mean()
    # ANUGA (DE1) asserts 1 % of L1 of the stage on this dam break (10 m against 1 m).
    figure(CASE, "L1 of h relative to the mean depth", relative, below=0.005, yardstick=0.01)


def test_first_order_run_fails_the_bounds():
    first = errors(solve(DAM, GRID, TIME, order=1), exact())
    assert all(first[norm] > bound for norm, bound in BOUNDS.items())


def test_wrong_solution_fails_the_bounds(computed):
    wrong = Stoker(h_left=10.0, h_right=1.1).state(*GRID.centres, TIME)
    assert errors(computed, wrong)["L1 of h"] > BOUNDS["L1 of h"]


def test_bore_stands_where_mass_and_momentum_put_it(computed, figure):
    h_m, _, bore = DAM.plateau
    x, h = GRID.centres[0][0], computed[0][0]
    middle = 0.5 * (h_m + DAM.h_right)
    last = np.flatnonzero(h > middle).max()
    found = x[last] + GRID.dx * (h[last] - middle) / (h[last] - h[last + 1])
    figure(CASE, "distance of the bore from the exact one", abs(found - bore * TIME), unit="m", below=5.0)


def test_no_overshoot_at_the_bore(computed, figure):
    over = max(computed[0].max() - DAM.h_left, DAM.h_right - computed[0].min())
    figure(CASE, "depth above the dam's or below the tail's", over, unit="m", below=0.0)
