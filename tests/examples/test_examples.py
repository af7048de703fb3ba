import csv
import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def run(case: Path, out: Path, *options: str) -> dict:
    code = "from solver_service.cli import main; main()"
    words = [sys.executable, "-c", code, "run", case, "--device", "cpu", "--json", "--out", out, *options]
    answer = subprocess.run(words, capture_output=True, text=True, timeout=120, check=True)
    return json.loads(answer.stdout.splitlines()[-1])


def gauge(out: Path, name: str) -> dict[float, float]:
    """Depth [m] against time [s]."""
    with (out / "gauges.csv").open() as lines:
        return {
            float(row["time_s"]): float(row["depth_m"])
            for row in csv.DictReader(lines)
            if row["gauge"] == name
        }


def test_the_flume_breaks_as_ritter_says(tmp_path: Path) -> None:
    figures = run(EXAMPLES / "dam_break", tmp_path / "out")

    assert abs(figures["volume_error_relative"]) < 1e-6
    # At the dam the depth is 4/9 of the water behind it from the first moment on (Ritter 1892).
    assert gauge(tmp_path / "out", "dam")[0.8] == pytest.approx(4.0 / 9.0, abs=0.03)
    # Friction holds the front back: it comes 3 m down later than 2 sqrt(g h) and before twice that time.
    soonest = 3.0 / (2.0 * math.sqrt(9.81))
    wet = [time for time, depth in gauge(tmp_path / "out", "downstream").items() if depth > 0.01]
    assert soonest < wet[0] < 2.0 * soonest


def test_the_synthetic_valley_is_written_and_floods_its_village(tmp_path: Path) -> None:
    case = tmp_path / "valley"
    subprocess.run([sys.executable, EXAMPLES / "synthetic_valley.py", case], check=True, timeout=60)

    figures = run(case, tmp_path / "out", "--until", "300")

    assert figures["cells"] == 36_000
    assert figures["hypothetical"] is True
    assert abs(figures["volume_error_relative"]) < 1e-6
    village = gauge(tmp_path / "out", "village")
    assert village[0.0] == 0.0
    assert max(village.values()) > 0.5
    assert figures["water_budget_m3"]["initial"] > 1e5
