"""Dam break on a dry, rough bed (Dressler 1952; SWASHES section 4.1.3, here with Manning friction): 10 m of
water, cells of 10 m, n = 0.02, 40 s.

The expansion in the friction judges the water behind the tip; front and tip are compared with the published
scheme on cells of 1.25 m, an independent solver that has converged to a tenth of a cell there.
"""

import pytest

from tests.validation.pictures import Line, Panel
from tests.validation.runs import channel, errors, l1, solve, solve_published
from tests.validation.solutions import Dressler

CASE = "Dressler: dam break on a dry, rough bed, 200 cells"
DAM = Dressler(h_left=10.0, manning_n=0.02)
GRID = channel(200, -1000.0, 1000.0)
TIME = 40.0
X = GRID.centres[0][0]
BEHIND = 0.7 * DAM.reach(TIME) > X  # where the second order of the friction does not count
BOUNDS = {
    "L1 of h": 0.0125,
    "L2 of h": 0.0274,
    "Linf of h": 0.17,
    "L1 of the unit discharge": 0.095,
    "L1 of the velocity": 0.014,
}


def row(state, where=slice(None)):
    return tuple(q[0][where] for q in state)


@pytest.fixture(scope="module")
def computed():
    return row(solve(DAM, GRID, TIME))


@pytest.fixture(scope="module")
def published():
    return row(solve_published(DAM, GRID, TIME))


@pytest.fixture(scope="module")
def fine():
    """The published scheme on eight cells for one, averaged."""
    state = solve_published(DAM, channel(1600, -1000.0, 1000.0, rows=1), TIME)
    return tuple(q[0].reshape(200, 8).mean(axis=1) for q in state)


def exact(dam=DAM):
    return tuple(q[BEHIND] for q in dam.state(X, 0.0 * X, TIME))


def behind(state):
    return tuple(q[BEHIND] for q in state)


def test_errors_behind_the_tip_stay_below_the_published_second_order_scheme(computed, published, compare):
    compare(CASE, BOUNDS, behind(computed), exact(), behind(published))


def test_whole_wave_with_its_tip_is_that_of_a_fine_grid(computed, published, fine, figure, picture):
    yardstick = l1(published[0], fine[0])
    found = l1(computed[0], fine[0])
    figure(CASE, "L1 of h against cells of 1.25 m", found, unit="m", below=0.0106, yardstick=yardstick)
    near = (X > -500.0) & (X < 550.0)
    behind_tip = BEHIND & near
    panels = (
        Panel(
            title,
            "x [m]",
            up,
            (
                Line("fine", X[near], fine[k][near]),
                Line("exact", X[behind_tip], DAM.state(X[behind_tip], 0.0 * X[behind_tip], TIME)[k]),
                Line("other", X[near], published[k][near]),
                Line("computed", X[near], computed[k][near]),
            ),
        )
        for k, (title, up) in enumerate((("depth", "h [m]"), ("velocity", "u [m/s]")))
    )
    picture(CASE, "dressler", *panels)


def test_front_is_found_within_a_cell(computed, published, fine, figure):
    ours, theirs, reference = (X[state[0] > 0.01].max() for state in (computed, published, fine))
    figure(
        CASE,
        "front (h = 1 cm) before that of the fine grid",
        ours - reference,
        unit="m",
        above=-GRID.dx,
        below=GRID.dx,
        yardstick=theirs - reference,
    )


def test_first_order_run_fails_the_bounds():
    first = errors(behind(row(solve(DAM, GRID, TIME, order=1))), exact())
    assert all(first[norm] > 1.3 * bound for norm, bound in BOUNDS.items())


@pytest.mark.parametrize("manning_n", [0.0, 0.025])
def test_wrong_roughness_fails_the_bounds(computed, manning_n):
    wrong = errors(behind(computed), exact(Dressler(10.0, manning_n)))
    assert wrong["L1 of h"] > 1.2 * BOUNDS["L1 of h"]
    assert wrong["L1 of the velocity"] > 2.0 * BOUNDS["L1 of the velocity"]
