"""Steady flow over a bump (Goutal and Maurel 1997; SWASHES sections 3.1.3 to 3.1.5), 200 cells of 12.5 cm.

Discharge enters through the western edge; in the east stands the level, or the flow leaves fast. It begins
with water at rest (behind the bump, where the flow will be fast, 20 cm of it), and no friction calms the
waves that run back and forth between the edges.
"""

import numpy as np
import pytest

from tests.validation import channels
from tests.validation.pictures import Line, Panel
from tests.validation.runs import errors
from tests.validation.solutions import Bump

CASE = "Flow over a bump, 200 cells"
CELLS, TIME = 200, 150.0
NORMS = ("L1 of h", "L2 of h", "Linf of h", "L1 of the unit discharge", "L1 of the velocity")
BUMPS = {
    "subcritical": Bump("subcritical", 4.42, 2.0),
    "transcritical": Bump("transcritical", 1.53, 0.66),
    "with a jump": Bump("jump", 0.18, 0.33),
}
BOUNDS = {
    "subcritical": (6e-05, 2.2e-04, 2.0e-03, 1.6e-04, 1.3e-04),
    "transcritical": (3.1e-04, 9e-04, 9.0e-03, 9e-05, 1.2e-03),
    "with a jump": (6e-04, 4.5e-03, 6.2e-02, 9.5e-04, 4.8e-03),
}
MISSES = {
    # The bed of the cells at the crest is flat under the limiter, as it is with minmod.
    "transcritical": {"L1 of h", "L2 of h", "Linf of h"},
    # Waves that still run back and forth, and h u in the cell of the jump.
    "with a jump": {"L1 of h", "L1 of the unit discharge", "L1 of the velocity"},
}


def exact(name):
    x, _ = channels.places(BUMPS[name], CELLS)
    return BUMPS[name].state(x, 0.0 * x, 0.0)


def start(name):
    """Water at rest."""
    x, _ = channels.places(BUMPS[name], CELLS)
    h = BUMPS[name].depth_out - BUMPS[name].bed(x, 0.0 * x)
    if channels.is_fast(BUMPS[name], BUMPS[name].length):
        h = np.where(x > 10.0, 0.2, h)
    return h, 0.0 * h


def run(name, **params):
    return channels.steady(BUMPS[name], CELLS, start(name), TIME, **params)


@pytest.fixture(scope="module")
def published():
    begin = [start(name) for name in BUMPS]
    states = channels.published(list(BUMPS.values()), CELLS, begin, [TIME] * len(BUMPS))
    return dict(zip(BUMPS, states, strict=True))


@pytest.mark.parametrize("name", BUMPS)
def test_flow_becomes_steady_with_the_exact_depth(name, published, compare, picture):
    computed = run(name)
    bounds = dict(zip(NORMS, BOUNDS[name], strict=True))
    missed = MISSES.get(name, ())
    compare(CASE, bounds, computed, exact(name), published[name], of=f", {name}", misses=missed)
    x, _ = channels.places(BUMPS[name], CELLS)
    bed = BUMPS[name].bed(x, 0.0 * x)
    lines = [Line("bed", x, bed), Line("exact", x, bed + exact(name)[0])]
    lines += [Line("other", x[::2], (bed + published[name][0])[::2])]
    lines += [Line("computed", x[::2], (bed + computed[0])[::2])]
    picture(CASE, "bump", Panel(name, "x [m]", "level [m]", tuple(lines)))


@pytest.mark.parametrize("name", BUMPS)
def test_first_order_run_fails_the_bounds(name):
    first = errors(run(name, order=1), exact(name))
    assert first["L1 of h"] > 1.5 * BOUNDS[name][0]
