"""A dam break against a building that stands askew in a flume.

Source: Soares-Frazao and Zech (2007), Experimental study of dam-break flow against an isolated obstacle, J.
Hydraul. Res. 45 (extra issue), 27-36 (UCL, IMPACT project; free of use with acknowledgement); test 6A of the
UK Environment Agency's benchmarks. The measured depths stand below as means over 2 s from the opening of the
gate on, and as arrivals (first depth above 0.021 m) and highest depths.
"""

import json

import numpy as np
import pytest

from tests.validation.benchmarks.case_folders import (
    Flood,
    data_folder,
    gauge_tables,
    read_polygon,
    write_polygons,
)
from tests.validation.pictures import Line, Panel

CASE = "Isolated building, 0.05 m, 72 x 716 cells, 30 s"
WINDOW = 2.0
MEASURED = {  # depth [m], means over 0-2 s, 2-4 s ... 28-30 s
    "G1": """0.0334 0.0816 0.0758 0.1051 0.1079 0.1032 0.1006 0.0915
        0.0904 0.0813 0.0771 0.0838 0.0647 0.0542 0.0545""",
    "G2": """0.0327 0.0399 0.0412 0.0389 0.0384 0.0352 0.0371 0.0666
        0.0768 0.1017 0.1039 0.1015 0.1007 0.0988 0.0922""",
    "G3": """0.0223 0.0899 0.0977 0.0986 0.1042 0.0848 0.0878 0.0860
        0.0860 0.0790 0.0616 0.0599 0.0754 0.0770 0.0762""",
    "G4": """0.0245 0.0658 0.1045 0.1089 0.0917 0.0885 0.0754 0.0959
        0.0947 0.0885 0.0800 0.0761 0.0761 0.0772 0.0749""",
    "G5": """0.0200 0.0385 0.0765 0.0695 0.0589 0.0802 0.0833 0.0725
        0.0649 0.0636 0.0563 0.0464 0.0496 0.0584 0.0485""",
    "G6": """0.3843 0.3528 0.3492 0.3336 0.2910 0.2704 0.2690 0.2601
        0.2362 0.2147 0.2088 0.2069 0.1981 0.1836 0.1696""",
}
ARRIVALS = {"G1": 1.09, "G2": 0.86, "G3": 1.81, "G4": 1.67, "G5": 2.71}
HIGHEST = {"G1": 0.125, "G2": 0.118, "G3": 0.116, "G4": 0.132, "G5": 0.108}

TEXT = """
[case]
name = "isolated_building"
crs = "local"

[terrain]
dem = "flume.npz"

[[terrain.raise]]
polygons = "walls.csv"
by = 1.0

[roughness]
manning_n = {manning_n}

[[initial.level]]
level = {reservoir}
side_of_line = [[{gate}, 0.0], [{gate}, 3.6]]

[[initial.level]]
level = {channel}
everywhere_below = true

[run]
duration = {duration}
output_interval = 1.0
gauge_interval = 0.02
depth_dry = 0.0001
"""


def build(folder, dx=0.05):
    """The flume as a case folder; returns its text."""
    source = data_folder("isolated_building", "isolated_building.json")
    facts = json.loads((source / "isolated_building.json").read_text(encoding="utf-8"))
    y = (np.arange(round(3.6 / dx)) + 0.5) * dx
    side = np.minimum(y, 3.6 - y)
    bed = np.where(side < 0.34, 0.155 / 0.34 * (0.34 - side), 0.0)
    bed = np.repeat(bed[:, None], round(35.8 / dx), axis=1)
    np.savez(folder / "flume.npz", bed=bed, x0=0.0, y0=0.0, dx=dx)
    write_polygons(folder / "walls.csv", [read_polygon(source / name) for name in facts["walls_z1m"]])
    rows = np.loadtxt(source / facts["gauges"], delimiter=",", skiprows=1)
    text = TEXT.format(
        manning_n=facts["manning_n"],
        reservoir=facts["reservoir_level_m"],
        channel=facts["downstream_level_m"],
        gate=facts["gate_x"],
        duration=facts["duration_s"],
    )
    return text + gauge_tables({f"G{number:.0f}": (x, y) for x, y, number in rows})


def measured(name):
    return np.array([float(word) for word in MEASURED[name].split()])


def windows(flood, name):
    """Means of the computed depth over the windows [m]."""
    number = (flood.times / WINDOW).astype(int)
    return np.array([flood.h[name][number == k].mean() for k in range(15)])


# RMSE [m] of the same windows and arrivals [s] by ANUGA 4.1.0 (DE1) on as many triangles as there are cells.
ANUGA_RMSE = {"G1": 0.0112, "G2": 0.0396, "G3": 0.0166, "G4": 0.0109, "G5": 0.0119, "G6": 0.0033}
ANUGA_ARRIVALS = {"G1": 1.60, "G2": 1.44, "G3": 2.48, "G4": 2.40, "G5": 3.52}


@pytest.fixture(scope="module")
def flood(tmp_path_factory):
    folder = tmp_path_factory.mktemp("isolated_building")
    return Flood(folder, build(folder)).run()


def rmse(computed, name):
    return float(np.sqrt(np.mean((computed - measured(name)) ** 2)))


@pytest.mark.slow
def test_depths_follow_the_measured_ones(flood, figure, picture):
    for name, yardstick in ANUGA_RMSE.items():
        error = rmse(windows(flood, name), name)
        still = rmse(np.full(15, 0.4 if name == "G6" else 0.02), name)
        figure(CASE, f"RMSE of h at {name}", error, unit="m", below=0.6 * still, yardstick=yardstick)
        lines = (
            Line("fine", flood.times[::5], flood.h[name][::5], "computed"),
            Line("other", WINDOW * (np.arange(15) + 0.5), measured(name), "measured, 2 s means"),
        )
        picture(CASE, "isolated_building", Panel(name, "t [s]", "h [m]", lines))
    channel = ARRIVALS.keys()
    found = np.sqrt(np.mean([rmse(windows(flood, name), name) ** 2 for name in channel]))
    yardstick = np.sqrt(np.mean([ANUGA_RMSE[name] ** 2 for name in channel]))
    figure(CASE, "RMSE of h, G1 to G5 together", found, unit="m", below=0.02, yardstick=yardstick)
    assert yardstick > 0.02, "the bound is laxer than the yardstick"


@pytest.mark.slow
def test_front_arrives_and_rises_as_the_equations_have_it(flood, figure):
    for name, seconds in ARRIVALS.items():
        found = flood.arrival(name, 0.021)
        text = f"arrival at {name} (measured {seconds} s)"
        figure(CASE, text, found, unit="s", below=ANUGA_ARRIVALS[name] + 0.1, yardstick=ANUGA_ARRIVALS[name])
        assert found >= seconds
    for name, depth in HIGHEST.items():
        text = f"highest h at {name} (measured {depth} m)"
        figure(CASE, text, flood.h[name].max(), unit="m", above=0.7 * depth, below=1.3 * depth)


@pytest.mark.slow
def test_flume_keeps_its_water(flood, figure):
    figure(CASE, "volume error", abs(flood.solver.budget().error_relative), below=1e-7, instead="round-off")
