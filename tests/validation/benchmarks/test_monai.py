"""The tsunami of 1993 at Monai on Okushiri, in a tank at 1:400: a wave runs up a valley behind an island.

Source: Matsuyama and Tanaka (2001), ITS 2001 Proceedings, session 7, 7-21; benchmark 2 of the Third
International Workshop on Long-Wave Run-up Models (Liu, Yeh and Synolakis 2008). The levels measured at the
gauges stand below every half second, averaged over 0.2 s. In nature the run-up was 31.7 m (Shuto and
Matsutomi 1995), 0.079 m at the scale of the tank.
"""

import json
import shutil

import numpy as np
import pytest

from tests.validation.benchmarks.case_folders import Flood, data_folder, gauge_tables, write_series
from tests.validation.pictures import Line, Panel

CASE = "Monai 1:400, 0.014 m, 244 x 393 cells, 22.5 s"
FIRST, EVERY = 10.0, 0.5
MEASURED = {  # level [cm] from 10 s on
    "ch5": """-0.03 -0.28 -0.43 -0.51 -0.60 -0.68 -0.80 -0.87 -0.90 0.45 0.70 1.01 1.24
        1.28 1.30 2.97 2.70 3.07 3.05 3.18 2.28 2.11 1.77 1.11 0.66 0.39""",
    "ch7": """-0.02 -0.19 -0.23 -0.26 -0.32 -0.42 -0.47 -0.51 -0.61 -0.46 0.82 1.38 1.75
        1.82 3.62 3.25 2.76 2.35 2.95 2.24 1.74 1.91 1.32 1.17 0.88 0.71""",
    "ch9": """0.13 0.12 0.09 0.01 -0.08 -0.16 -0.21 -0.23 -0.25 -0.26 0.68 1.13 1.64
        2.65 3.59 3.65 3.02 2.33 1.82 1.46 1.61 1.08 1.01 1.02 0.86 0.43""",
}
HIGHEST = {"ch5": 0.0369, "ch7": 0.0390, "ch9": 0.0454}
RUN_UP_NATURE = 31.7 / 400.0

TEXT = """
[case]
name = "monai"
crs = "local"

[terrain]
dem = "Monai_bathymetry.tif"

[roughness]
manning_n = 0.01

[[initial.level]]
level = 0.0
everywhere_below = true

[[boundary]]
id = "wave"
edge = "west"
kind = "stage"
series = "wave.csv"

[run]
duration = 22.5
output_interval = 0.5
gauge_interval = 0.05
depth_dry = 0.0001
"""


def build(folder):
    """The tank as a case folder; returns its text."""
    source = data_folder("monai", "Monai_bathymetry.tif")
    facts = json.loads((source / "monai.json").read_text(encoding="utf-8"))
    shutil.copyfile(source / "Monai_bathymetry.tif", folder / "Monai_bathymetry.tif")
    times, levels = np.loadtxt(source / "Benchmark_2_input.txt", skiprows=1).T
    write_series(folder / "wave.csv", "level_m", times, levels)
    return TEXT + gauge_tables(facts["gauges"])


def measured(name):
    """Times [s] and levels [m]."""
    levels = 0.01 * np.array([float(word) for word in MEASURED[name].split()])
    return FIRST + EVERY * np.arange(levels.size), levels


def computed(flood, name):
    """Levels at the times of the measured ones, averaged over 0.2 s as they are [m]."""
    times, _ = measured(name)
    return np.array([flood.level[name][np.abs(flood.times - time) <= 0.101].mean() for time in times])


# RMSE [m] of the same levels by ANUGA 4.1.0 (DE1) on as many triangles as there are cells.
ANUGA_RMSE = {"ch5": 0.00410, "ch7": 0.00303, "ch9": 0.00397}


@pytest.fixture(scope="module")
def flood(tmp_path_factory):
    folder = tmp_path_factory.mktemp("monai")
    return Flood(folder, build(folder)).run()


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_levels_follow_the_gauges_of_the_tank(flood, figure, picture):
    for name, yardstick in ANUGA_RMSE.items():
        levels, (_, tank) = computed(flood, name), measured(name)
        error = float(np.sqrt(np.mean((levels - tank) ** 2)))
        figure(
            CASE, f"RMSE of the level at {name}", error, unit="m", below=1.03 * yardstick, yardstick=yardstick
        )
        assert yardstick < 0.5 * float(np.sqrt(np.mean(tank**2))), "a tank at rest would pass"
        highest = float(flood.level[name].max())
        text = f"highest level at {name} (measured {HIGHEST[name]} m)"
        figure(CASE, text, highest, unit="m", above=0.85 * HIGHEST[name], below=1.15 * HIGHEST[name])
        lines = (
            Line("fine", flood.times[200:], flood.level[name][200:], "computed"),
            Line("other", measured(name)[0], tank, "measured"),
        )
        picture(CASE, "monai", Panel(name, "t [s]", "level [m]", lines))


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_wave_runs_up_the_valley_as_high_as_in_nature(flood, figure):
    highest = flood.solver.maxima().h
    ground = flood.case.z_b
    run_up = float(ground[(highest > 5e-4) & (ground > 0.0)].max())
    text = "run-up in the valley (in nature 0.079 m)"
    figure(CASE, text, run_up, unit="m", above=0.9 * RUN_UP_NATURE, below=1.2 * RUN_UP_NATURE)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_water_that_passes_the_paddle_is_booked(flood, figure):
    budget = flood.solver.budget()
    into, out = budget.edges["wave"]
    figure(CASE, "volume through the western edge, in", into, unit="m3")
    figure(CASE, "volume through the western edge, out", out, unit="m3")
    figure(CASE, "volume error", abs(budget.error_relative), below=1e-6, instead="round-off")
