"""The flood of June 2007 in Merewether, Newcastle (Australia): a street with sixty houses.

Source: Smith and Wasko (2012), Australian Rainfall and Runoff, Revision Project 15, Two-Dimensional
Simulations in Urban Areas: the 19.7 m3/s of the physical model, five surveyed flood marks (Table 4) and the
levels that TUFLOW computed there (Table 9, cells of 0.5, 1 and 2 m). Terrain, houses and road are those of
ANUGA's validation case.
"""

import json
import zipfile

import numpy as np
import pytest

from tests.validation.benchmarks.case_folders import (
    Flood,
    data_folder,
    gauge_tables,
    read_polygon,
    write_polygons,
)

CASE = "Merewether 2007, 1 m, 416 x 321 cells, to steady flow"
HOUSE_HEIGHT = 3.0

MARKS = {
    "44": (382373.5145, 6354387.8371),
    "43": (382354.6103, 6354365.2083),
    "31": (382424.3999, 6354478.3335),
    "32": (382509.7135, 6354548.2208),
    "42": (382339.4160, 6354297.8367),
}
OBSERVED = {"44": 23.01, "43": 23.14, "31": 19.98, "32": 18.38, "42": 23.36}
TUFLOW = {  # Table 9 of Smith and Wasko, by cell size [m]
    0.5: {"44": 22.69, "43": 22.91, "31": 19.85, "32": 18.12, "42": 23.43},
    1.0: {"44": 22.79, "43": 23.10, "31": 20.09, "32": 18.34, "42": 23.57},
    2.0: {"44": 22.77, "43": 23.11, "31": 20.09, "32": 18.20, "42": 23.58},
}

TEXT = """
[case]
name = "merewether"
title = "Street flood in Merewether, 2007"
crs = "EPSG:32756"

[terrain]
dem = "topography1.asc"

[[terrain.raise]]
polygons = "houses.csv"
by = {house}

[roughness]
manning_n = 0.04

[[roughness.zone]]
polygons = "road.csv"
manning_n = 0.02

[[source]]
id = "inflow"
at = {centre}
radius = {radius}
discharge = {discharge}

[[boundary]]
id = "east"
edge = "east"
kind = "open"

[[boundary]]
id = "north"
edge = "north"
kind = "open"

[run]
duration = {duration}
output_interval = 1.0
gauge_interval = 1.0
"""


def mean_error(levels):
    return float(np.mean([abs(levels[name] - OBSERVED[name]) for name in OBSERVED]))


def build(folder, duration):
    """The case folder of the flood; returns its text."""
    source = data_folder("merewether", "topography1.zip")
    facts = json.loads((source / "merewether.json").read_text(encoding="utf-8"))
    with zipfile.ZipFile(source / "topography1.zip") as archive:
        archive.extract("topography1.asc", folder)
    write_polygons(
        folder / "houses.csv", [read_polygon(path) for path in sorted((source / "houses").glob("*.csv"))]
    )
    write_polygons(folder / "road.csv", [read_polygon(source / "Road" / "RoadPolygon.csv")])
    inflow = facts["inflow"]
    text = TEXT.format(
        house=HOUSE_HEIGHT,
        centre=inflow["disc_centre"],
        radius=inflow["radius_m"],
        discharge=inflow["Q_m3s"],
        duration=duration,
    )
    return text + gauge_tables(MARKS)


@pytest.fixture(scope="module")
def flood(tmp_path_factory):
    folder = tmp_path_factory.mktemp("merewether")
    return Flood(folder, build(folder, 700.0)).run()


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_levels_at_the_flood_marks_are_as_good_as_those_of_tuflow(flood, figure):
    levels = {name: float(flood.level[name][-50:].mean()) for name in MARKS}
    for name, level in levels.items():
        off = level - OBSERVED[name]
        figure(
            CASE,
            f"level at mark {name} less observed",
            off,
            unit="m",
            yardstick=TUFLOW[1.0][name] - OBSERVED[name],
        )
    for size in (0.5, 2.0):
        figure(CASE, f"mean error of TUFLOW on {size} m", mean_error(TUFLOW[size]), unit="m")
    found = mean_error(levels)
    figure(CASE, "mean error at five marks", found, unit="m", below=0.156, yardstick=mean_error(TUFLOW[1.0]))


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_flow_is_steady_and_what_comes_in_goes_out(flood, figure):
    wet = [name for name in MARKS if flood.h[name][-1] > 0.01]
    assert wet == ["44", "31", "32"]
    for name in wet:
        assert np.ptp(flood.level[name][-50:]) < 0.02
    budget = flood.solver.budget()
    inflow = sum(budget.sources.values())
    figure(CASE, "volume stored at the end", budget.stored, unit="m3")
    figure(CASE, "volume error", abs(budget.error_relative), below=1e-7, instead="round-off")
    assert inflow == pytest.approx(19.7 * 700.0, rel=1e-5)


def test_houses_stand_above_the_street(tmp_path):
    case = Flood(tmp_path, build(tmp_path, 1.0)).case
    assert case.model.shape == (416, 321)
    n = np.asarray(case.model.manning_n)
    assert 0.05 < (n < 0.03).mean() < 0.3
    bare = tmp_path / "bare"
    bare.mkdir()
    build(bare, 1.0)
    text = (tmp_path / "case.toml").read_text(encoding="utf-8")
    cut = text[: text.index("[[terrain.raise]]")] + text[text.index("[roughness]") :]
    raised = case.z_b - Flood(bare, cut).case.z_b
    assert raised.max() == pytest.approx(HOUSE_HEIGHT, abs=1e-3)
    assert 0.03 < (raised > 1.0).mean() < 0.2
