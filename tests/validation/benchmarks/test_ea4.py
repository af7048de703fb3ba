"""How fast a flood spreads over a flat floodplain: test 4 of the UK Environment Agency's 2D benchmarks.

Source: Neelz and Pender (2013), Benchmarking the Latest Generation of 2D Hydraulic Modelling Packages,
SC120002, Environment Agency; as specified by Shaw et al. (2021), Geosci. Model Dev. 14, 3577-3602. The
published results are curves; what can be read off them is listed: arrival (first depth of 0.05 and 0.15 m),
highest depth and speed at the six points. The yardstick is ANUGA 4.1.0 (DE1) on as many triangles; its inlet
is an area of 20 m x 20 m, so that its water starts 20 m nearer to the points.
"""

import json

import numpy as np
import pytest

from tests.validation.benchmarks.case_folders import Flood, data_folder, gauge_tables, write_series

CASE = "EA test 4: flat floodplain, 10 m, 200 x 100 cells, 5 h"

ANUGA = {  # arrival of 0.05 and 0.15 m [s], highest depth [m] and speed [m/s]
    "P1": (680.0, 1250.0, 0.326, 0.409),
    "P2": (1090.0, 1895.0, 0.275, 0.247),
    "P3": (1960.0, 3105.0, 0.228, 0.158),
    "P4": (2895.0, 4390.0, 0.201, 0.125),
    "P5": (3870.0, 6635.0, 0.180, 0.108),
    "P6": (4120.0, 7370.0, 0.176, 0.106),
}
HYDROGRAPH_VOLUME = 20.0 * (0.5 * 3300.0 + 10800.0 + 0.5 * 3600.0)

TEXT = """
[case]
name = "ea_test4"
crs = "local"

[terrain]
dem = "plain.npz"

[roughness]
manning_n = {manning_n}

[[boundary]]
id = "breach"
edge = "west"
from = {first}
to = {last}
kind = "discharge"
series = "inflow.csv"

[[boundary]]
edge = "east"
kind = "open"

[[boundary]]
edge = "north"
kind = "open"

[[boundary]]
edge = "south"
kind = "open"

[run]
duration = {duration}
output_interval = 600.0
gauge_interval = 5.0
"""


def build(folder, dx=10.0):
    """The floodplain as a case folder; returns its text."""
    source = data_folder("ea_test4", "ea_test4.json")
    facts = json.loads((source / "ea_test4.json").read_text(encoding="utf-8"))
    width, length = facts["domain_m"]
    bed = np.zeros((round(length / dx), round(width / dx)))
    np.savez(folder / "plain.npz", bed=bed, x0=0.0, y0=0.0, dx=dx)
    inflow = facts["inflow"]
    times, unit = np.array(inflow["unit_discharge_m2s"], np.float64).T
    write_series(folder / "inflow.csv", "discharge_m3_s", times, unit * inflow["width_m"])
    text = TEXT.format(
        manning_n=facts["manning_n"],
        first=inflow["y_from"],
        last=inflow["y_to"],
        duration=facts["duration_s"],
    )
    return text + gauge_tables({f"P{name}": tuple(at) for name, at in facts["points"].items()})


@pytest.fixture(scope="module")
def flood(tmp_path_factory):
    folder = tmp_path_factory.mktemp("ea_test4")
    return Flood(folder, build(folder)).run()


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_flood_reaches_the_points_and_rises_as_another_solver_has_it(flood, figure):
    for name, (arrival, later, highest, fastest) in ANUGA.items():
        for depth, seconds in ((0.05, arrival), (0.15, later)):
            found = flood.arrival(name, depth)
            margin = max(75.0, 0.04 * seconds)
            bounds = {"above": seconds - margin, "below": seconds + margin, "yardstick": seconds}
            figure(CASE, f"arrival of {depth} m at {name}", found, unit="s", **bounds)
        bounds = {"above": highest - 0.005, "below": highest + 0.005, "yardstick": highest}
        figure(CASE, f"highest depth at {name}", flood.h[name].max(), unit="m", **bounds)
        speed = flood.speed[name].max()
        figure(CASE, f"highest speed at {name}", speed, unit="m/s", yardstick=fastest)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_flood_on_flat_ground_is_symmetric_and_keeps_the_hydrograph(flood, figure):
    depth = flood.solver.depth()
    figure(CASE, "largest difference of h, mirrored", np.abs(depth - depth[::-1]).max(), unit="m", below=0.0)
    budget = flood.solver.budget()
    short = abs(budget.edges["breach"][0] / HYDROGRAPH_VOLUME - 1.0)
    figure(CASE, "inflow less the hydrograph's volume", short, below=1e-6, instead="round-off")
    figure(CASE, "volume error", abs(budget.error_relative), below=1e-6, instead="round-off")
    figure(CASE, "volume on the plain at the end", budget.stored, unit="m3")
