"""The Malpasset dam break of 1959 on a 15 m raster: what the police and three transformers saw.

Source: Hervouet and Petitjean (1999), "Malpasset dam-break revisited with two-dimensional computations", J.
Hydraul. Res. 37(6), 777-788; Goutal (1999), CADAM. Mesh and roughness (Strickler 30) are those of the
TELEMAC-2D example. Five of the seventeen police marks lie below the bed of that mesh and are not used. The
data are found through ``FEV_DATA_HOME``.
"""

import csv
import os
import time
from pathlib import Path

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ShallowWaterSolver, SolverParams

CASE = "Malpasset 1959, 15 m, 613 x 1150 cells, 4000 s"
MANNING_N = 1.0 / 30.0
OUTSIDE = 100.9


def folder():
    home = os.environ.get("FEV_DATA_HOME")
    if not home:
        pytest.skip("FEV_DATA_HOME is not set: the Malpasset data are not part of the repository")
    path = Path(home) / "malpasset"
    if not (path / "malpasset_15m.npz").is_file():
        pytest.skip(f"{path / 'malpasset_15m.npz'} is missing")
    return path


def table(name):
    with (folder() / name).open(newline="", encoding="utf-8") as lines:
        return {row["id"]: row for row in csv.DictReader(lines)}


class Malpasset:
    """The case, its solver and where its points lie."""

    def __init__(self, **params):
        data = np.load(folder() / "malpasset_15m.npz")
        self.dx, self.x0, self.y0 = float(data["dx"]), float(data["x0"]), float(data["y0"])
        self.bed = np.ascontiguousarray(data["bed"][::-1])
        depth = np.ascontiguousarray(data["depth0"][::-1])
        self.points = table("malpasset_probe_points.csv")
        model = FloodModel(dx=self.dx, z_b=self.bed, manning_n=MANNING_N, blocked=self.bed > OUTSIDE)
        self.solver = ShallowWaterSolver(model, SolverParams(**params), device="cpu")
        self.solver.set_water(depth)
        self.wall_seconds = 0.0

    def cell(self, name):
        """Row and column of the cell that holds the point."""
        at = self.points[name]
        return int((float(at["y_m"]) - self.y0) / self.dx), int((float(at["x_m"]) - self.x0) / self.dx)


def test_first_minute_keeps_its_volume_and_reaches_the_valley(figure):
    case = Malpasset()
    before = float(case.solver.depth().astype(np.float64).sum())
    case.solver.advance_to(60.0)
    after = float(case.solver.depth().astype(np.float64).sum())
    figure(CASE, "volume error after 60 s", abs(after / before - 1.0), below=1e-6, instead="round-off")
    arrival = case.solver.maxima().arrival_time[case.cell("S6")]
    assert 0.0 < arrival < 60.0


@pytest.fixture(scope="module")
def flood():
    case = Malpasset()
    began = time.perf_counter()
    case.solver.advance_to(4000.0)
    case.wall_seconds = time.perf_counter() - began
    return case


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_highest_levels_match_the_police_marks(flood, figure):
    marks = {k: row for k, row in table("observed_police_marks.csv").items() if row["usable"] == "yes"}
    assert len(marks) == 12
    level = flood.solver.maxima().h + flood.bed
    misses = []
    for name, row in marks.items():
        misses.append(float(level[flood.cell(name)]) - float(row["observed_max_level_m"]))
        figure(CASE, f"level at {name}, computed less observed", misses[-1], unit="m")
    misses = np.array(misses)
    figure(CASE, "bias over 12 police marks", misses.mean(), unit="m")
    figure(CASE, "RMSE over 12 police marks", np.sqrt((misses**2).mean()), unit="m", below=3.3, yardstick=3.1)


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_flood_reaches_the_transformers_when_they_failed(flood, figure):
    observed = {k: float(row["observed_arrival_s"]) for k, row in table("observed_transformers.csv").items()}
    found = {k: float(flood.solver.maxima().arrival_time[flood.cell(k)]) for k in observed}
    for name, seconds in observed.items():
        margin = 60.0 if name == "A" else 0.15 * seconds
        bounds = {"above": seconds - margin, "below": seconds + margin}
        figure(
            CASE, f"arrival at transformer {name} (observed {seconds:.0f} s)", found[name], unit="s", **bounds
        )
    for name in ("B", "C"):
        seconds = observed[name] - observed["A"]
        took = found[name] - found["A"]
        figure(CASE, f"from A to {name} (observed {seconds:.0f} s)", took, unit="s")


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_whole_flood_keeps_its_volume(flood, figure):
    error = abs(flood.solver.budget().error_relative)
    figure(CASE, "volume error after 4000 s", error, below=1e-6, instead="round-off")
    faster = 4000.0 / flood.wall_seconds
    figure(CASE, "times faster than real time", faster, instead="depends on the machine")
    assert np.isfinite(flood.solver.depth()).all()
