"""Water in a paraboloid without friction, third oscillation, with a shore that moves all the time.

Source: Thacker (1981), J. Fluid Mech. 107, 499-508; SWASHES section 4.2.2: a plane surface that circles, and
a curved surface that swells and sinks.
"""

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from tests.validation.pictures import Line, Panel
from tests.validation.runs import Grid, errors, l1, order_of, solve, solve_published, square
from tests.validation.shores import energy, shore_mismatch
from tests.validation.solutions import ThackerPlanar, ThackerRadial


@dataclass(frozen=True)
class Basin:
    """A basin, its grid, and what its errors may be."""

    case: str
    bowl: ThackerPlanar | ThackerRadial
    wrong: ThackerPlanar | ThackerRadial
    size: float
    kept: float
    picture: str
    bounds: dict[str, float] = field(hash=False)

    @property
    def grid(self) -> Grid:
        return square(80, self.size)

    @property
    def time(self):
        return 2.25 * self.bowl.period

    def exact(self, grid=None):
        return self.bowl.state(*(grid or self.grid).centres, self.time)

    def perimeter(self):
        """Length of the shore [m]."""
        radius = self.bowl.a if isinstance(self.bowl, ThackerPlanar) else self.bowl.shore(self.time)
        return 2.0 * np.pi * radius

    def motion_left(self, state):
        """Energy of the motion in units of that at the start."""
        bed = self.bowl.bed(*self.grid.centres)
        rest = energy((np.maximum(-bed, 0.0), 0.0 * bed, 0.0 * bed), bed)
        start = energy(self.bowl.state(*self.grid.centres, 0.0), bed)
        return (energy(state, bed) - rest) / (start - rest)


PLANE, CURVED = ThackerPlanar(1000.0, 10.0, 500.0), ThackerRadial(1000.0, 10.0, 800.0)
BASINS = {
    "plane": Basin(
        "Thacker: plane surface in a paraboloid, 80 x 80 cells, 2.25 revolutions",
        PLANE,
        replace(PLANE, sigma=480.0),
        4000.0,
        0.96,
        "thacker_plane",
        {
            "L1 of h": 0.0207,
            "L2 of h": 0.0592,
            "Linf of h": 0.575,
            "L1 of the unit discharge": 0.285,
            "L1 of the velocity": 0.245,
        },
    ),
    "curved": Basin(
        "Thacker: curved surface in a paraboloid, 80 x 80 cells, 2.25 oscillations",
        CURVED,
        replace(CURVED, r0=780.0),
        3000.0,
        0.88,
        "thacker_curved",
        {
            "L1 of h": 0.0208,
            "L2 of h": 0.0522,
            "Linf of h": 0.343,
            "L1 of the unit discharge": 0.274,
            "L1 of the velocity": 0.193,
        },
    ),
}


def sections(basin, computed, published):
    """Surface and speed along the basin from south to north."""
    x, y = basin.grid.centres
    middle = basin.grid.ncols // 2
    bed, y = basin.bowl.bed(x, y)[:, middle], y[:, middle]
    near = bed < 0.8 * basin.bowl.h0
    levels, speeds = [Line("bed", y[near], bed[near])], []
    for kind, state in (("exact", basin.exact()), ("other", published), ("computed", computed)):
        h, u, v = (q[:, middle] for q in state)
        wet = near & (h > 0.1)
        levels.append(Line(kind, y[wet], (bed + h)[wet]))
        speeds.append(Line(kind, y[wet], np.hypot(u, v)[wet]))
    return (
        Panel("surface in the middle", "y [m]", "level [m]", tuple(levels)),
        Panel("speed in the middle", "y [m]", "speed [m/s]", tuple(speeds)),
    )


@pytest.fixture(scope="module", params=BASINS.values(), ids=BASINS)
def basin(request):
    return request.param


@pytest.fixture(scope="module")
def computed(basin):
    return solve(basin.bowl, basin.grid, basin.time)


@pytest.fixture(scope="module")
def published(basin):
    return solve_published(basin.bowl, basin.grid, basin.time)


def test_errors_stay_below_the_published_second_order_scheme(basin, computed, published, compare, picture):
    compare(basin.case, basin.bounds, computed, basin.exact(), published)
    picture(basin.case, basin.picture, *sections(basin, computed, published))


def test_first_order_run_fails_the_bounds(basin):
    first = errors(solve(basin.bowl, basin.grid, basin.time, order=1), basin.exact())
    norms = ("L1 of h", "L2 of h", "L1 of the unit discharge")
    assert all(first[norm] > 3.0 * basin.bounds[norm] for norm in norms)


def test_wrong_solution_fails_the_bounds(basin, computed):
    wrong = basin.wrong.state(*basin.grid.centres, basin.time)
    assert errors(computed, wrong)["L1 of h"] > basin.bounds["L1 of h"]


def test_shore_is_found_within_a_fraction_of_a_cell(basin, computed, figure):
    off = shore_mismatch(computed[0], basin.exact()[0], 0.1, basin.grid.dx, basin.perimeter())
    figure(basin.case, "mean distance of the shore (h = 0.1 m)", off, unit="cells", below=0.5)


def test_energy_of_the_motion_hardly_decays(basin, computed, published, figure):
    kept = basin.motion_left(computed)
    yardstick = basin.motion_left(published)
    assert basin.kept >= yardstick
    figure(
        basin.case,
        "energy of the motion that is left",
        kept,
        above=basin.kept,
        below=1.001,
        yardstick=yardstick,
    )


def test_error_falls_faster_than_the_cell_although_the_shore_moves(basin, computed, figure):
    fine = square(160, basin.size)
    found = [
        l1(computed[0], basin.exact()[0]),
        l1(solve(basin.bowl, fine, basin.time)[0], basin.exact(fine)[0]),
    ]
    figure(basin.case, "order of L1 of h, 80 to 160 cells a side", order_of(found), above=1.2)


def test_round_basin_keeps_its_eight_symmetries(figure):
    basin = BASINS["curved"]
    h = solve(basin.bowl, basin.grid, basin.time)[0]
    mirrored = (h[::-1], h[:, ::-1], h.T, h[::-1, ::-1])
    off = max(np.abs(h - other).max() for other in mirrored)
    figure(basin.case, "largest difference between mirror images", off, unit="m", below=0.0)
