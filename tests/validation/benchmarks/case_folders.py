"""Benchmarks become case folders and are read as every other case is.

The data are found through ``FEV_DATA_HOME``; they are not part of the repository: their licences differ.
"""

import os
from pathlib import Path

import numpy as np
import pytest

from solver_service.numerics import ShallowWaterSolver
from solver_service.scenario import Case, load_case


def data_folder(name: str, needed: str) -> Path:
    """Folder of a benchmark; the test is skipped where the file ``needed`` is missing."""
    home = os.environ.get("FEV_DATA_HOME")
    if not home:
        pytest.skip(f"FEV_DATA_HOME is not set: the data of {name} are not part of the repository")
    path = Path(home) / name
    if not (path / needed).is_file():
        pytest.skip(f"{path / needed} is missing")
    return path


def read_polygon(path: Path) -> np.ndarray:
    """Vertices of a CSV of x,y lines, with or without a line of names."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
    if any(letter.isalpha() and letter != "e" for letter in lines[0]):
        lines = lines[1:]
    return np.array([[float(word) for word in line.split(",")[:2]] for line in lines])


def write_polygons(path: Path, polygons: list[np.ndarray]) -> None:
    """Several polygons in one CSV, apart by empty lines."""
    blocks = ["\n".join(f"{x:.6f},{y:.6f}" for x, y in polygon) for polygon in polygons]
    path.write_text("x,y\n" + "\n\n".join(blocks) + "\n", encoding="utf-8")


def write_series(path: Path, name: str, times: np.ndarray, values: np.ndarray) -> None:
    """A series against ``time_s``."""
    rows = [f"{time:.6f},{value:.8f}" for time, value in zip(times, values, strict=True)]
    path.write_text(f"time_s,{name}\n" + "\n".join(rows) + "\n", encoding="utf-8")


def gauge_tables(points: dict[str, tuple[float, float]]) -> str:
    """``[[gauge]]`` tables of named points."""
    return "".join(f'\n[[gauge]]\nid = "{name}"\nat = [{x}, {y}]\n' for name, (x, y) in points.items())


class Flood:
    """A case folder, read, solved to its end, with its gauges as arrays.

    Attributes:
        case: the case as the reader made it.
        solver: after the run.
        times: of the gauge records [s].
        h: depth at the gauges by name [m].
        level: water level at the gauges by name [m above the datum of the case].
        speed: at the gauges by name [m/s].
    """

    def __init__(self, folder: Path, text: str) -> None:
        (folder / "case.toml").write_text(text, encoding="utf-8")
        self.case: Case = load_case(folder)
        self.solver = ShallowWaterSolver(self.case.model, self.case.params, device="cpu")
        self.solver.set_water(self.case.initial_h)

    def run(self) -> "Flood":
        """Solve to the end of the case."""
        self.solver.advance_to(self.case.duration)
        series = self.solver.gauge_series()
        names = [gauge.id for gauge in self.case.gauges]
        self.times = series.times
        self.h = {name: series.h[:, k] for k, name in enumerate(names)}
        self.speed = {name: np.hypot(series.u[:, k], series.v[:, k]) for k, name in enumerate(names)}
        self.level = {}
        for k, name in enumerate(names):
            col, row = self.case.params.gauges[k]
            bed = float(self.case.z_b[round(row), round(col)]) + self.case.grid.datum_offset
            self.level[name] = self.h[name] + bed
        return self

    def arrival(self, name: str, depth: float) -> float:
        """First recorded time with at least ``depth`` [m] at a gauge [s]; inf where it never is."""
        wet = np.flatnonzero(self.h[name] >= depth)
        return float(self.times[wet[0]]) if wet.size else float("inf")
