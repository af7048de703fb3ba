"""Steady flow in MacDonald's channels (MacDonald et al. 1997; SWASHES sections 3.2 and 3.3), 200 cells.

Discharge comes in through the western edge, the level stands at the eastern one, and the flow has to find its
profile, its critical point and its jump from water of the same depth everywhere. An edge knows one number,
the discharge, and fast inflow needs two; such channels get an approach of the same ground before x = 0. The
published scheme is told both numbers.
"""

import numpy as np
import pytest

from tests.validation import channels
from tests.validation.pictures import Line, Panel
from tests.validation.runs import errors
from tests.validation.solutions import CHANNELS

CASE = "MacDonald's channels, 200 cells"
CELLS = 200
NORMS = ("L1 of h", "L2 of h", "Linf of h", "L1 of the unit discharge", "L1 of the velocity")
BOUNDS = {
    "subcritical": (3e-05, 4e-05, 2.6e-04, 3e-05, 6e-05),
    "supercritical": (2.4e-05, 3.5e-05, 8e-05, 6e-05, 6e-05),
    "sub- to supercritical": (1.5e-05, 2.5e-05, 2.4e-04, 2e-05, 4e-05),
    "super- to subcritical": (4.6e-04, 3.0e-03, 2.95e-02, 5.4e-04, 1.27e-03),
    "short, smooth transition": (1.6e-05, 9e-05, 1.05e-03, 2.5e-05, 5e-05),
    "short, transition and jump": (1.25e-03, 1.53e-02, 2.15e-01, 1.72e-03, 4.1e-03),
    "long and undulating": (6.6e-04, 8.7e-04, 6.5e-03, 7.7e-04, 7.6e-04),
    "subcritical with rain": (4.0e-04, 4.1e-04, 1.0e-03, 3e-05, 7.5e-04),
    "supercritical with rain": (2.9e-04, 2.9e-04, 3.3e-04, 9e-05, 1.75e-03),
}
PICTURED = ("super- to subcritical", "short, smooth transition", "short, transition and jump")
RAINED = {"L1 of h", "L2 of h", "Linf of h", "L1 of the velocity"}
MISSES = {
    # In the cell that holds a jump h u is not the discharge that passes the faces.
    "super- to subcritical": {"L1 of the unit discharge"},
    "short, transition and jump": {"L1 of the unit discharge"},
    # The depth is seen after all rain of a step has come: half a millimetre at 3.6 metres of rain an hour.
    "subcritical with rain": RAINED,
    "supercritical with rain": RAINED,
    # Rounding of float32, and the one cell at the inflow.
    "supercritical": {"L1 of the unit discharge"},
    "short, smooth transition": {"Linf of h"},
}


def exact(name):
    x, _ = channels.places(CHANNELS[name], CELLS)
    return CHANNELS[name].state(x, 0.0 * x, 0.0)


def start(name):
    """The mean depth and discharge everywhere."""
    h, u, _ = exact(name)
    return np.full(CELLS, h.mean()), np.full(CELLS, (h * u).mean() / h.mean())


def until(name):
    """Time to become steady [s]."""
    return max(1.5 * CHANNELS[name].length, 400.0)


def run(name, **params):
    approach = CELLS // 4 if channels.is_fast(CHANNELS[name], 0.0) else 0
    return channels.steady(CHANNELS[name], CELLS, start(name), until(name), approach, **params)


@pytest.fixture(scope="module")
def published():
    begin, times = [start(name) for name in CHANNELS], [until(name) for name in CHANNELS]
    states = channels.published(list(CHANNELS.values()), CELLS, begin, times)
    return dict(zip(CHANNELS, states, strict=True))


@pytest.mark.parametrize("name", CHANNELS)
def test_channel_becomes_steady_with_the_exact_profile(name, published, compare, picture):
    computed, bounds = run(name), dict(zip(NORMS, BOUNDS[name], strict=True))
    missed = MISSES.get(name, ())
    compare(CASE, bounds, computed, exact(name), published[name], of=f", {name}", misses=missed)
    if name in PICTURED:
        x, _ = channels.places(CHANNELS[name], CELLS)
        bed, every = CHANNELS[name].bed(x, 0.0 * x), slice(None, None, 4)
        lines = [Line("bed", x, bed), Line("exact", x, bed + exact(name)[0])]
        lines += [Line("other", x[every], (bed + published[name][0])[every])]
        lines += [Line("computed", x[every], (bed + computed[0])[every])]
        picture(CASE, "macdonald", Panel(name, "x [m]", "level [m]", tuple(lines)))


@pytest.mark.parametrize("name", ["subcritical", "short, transition and jump", "supercritical with rain"])
def test_first_order_run_fails_the_bounds(name):
    first = errors(run(name, order=1), exact(name))
    assert first["L1 of h"] > 1.3 * BOUNDS[name][0]


@pytest.mark.parametrize("name", CHANNELS)
def test_depth_wrong_by_a_twentieth_fails_the_bounds(name):
    h, u, v = exact(name)
    wrong = errors((1.05 * h, u / 1.05, v), exact(name))
    assert all(wrong[norm] > BOUNDS[name][NORMS.index(norm)] for norm in ("L1 of h", "L1 of the velocity"))
