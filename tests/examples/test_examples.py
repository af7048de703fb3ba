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


def column(table: Path, name: str, **where: str) -> list[float]:
    """One column of the lines of a table that have the values asked for."""
    with table.open() as lines:
        return [
            float(row[name])
            for row in csv.DictReader(lines)
            if all(row[key] == value for key, value in where.items())
        ]


def test_the_levee_breaks_and_the_town_is_flooded_through_the_gap(tmp_path: Path) -> None:
    out = tmp_path / "out"

    figures = run(EXAMPLES / "levee_breach", out)

    budget = figures["water_budget_m3"]
    assert figures["warnings"] == []
    assert abs(figures["volume_error_relative"]) < 1e-6
    # 5 minutes of 20 mm/h and 10 of 80 mm/h on 240 000 m2; the meadow takes most of it and some river water.
    assert budget["rain"] == pytest.approx((5.0 * 20.0 + 10.0 * 80.0) / 60e3 * 240_000.0, rel=1e-3)
    assert 0.0 < budget["infiltration"] < 2.0 * budget["rain"]
    assert budget["edges"]["river"]["in"] > 1e5
    (levee,) = figures["breaches"]
    assert (levee["started_at_s"], levee["level_m"]) == (300.0, pytest.approx(2.0))
    assert levee["width_m"] > 10.0

    town = gauge(out, "town")
    assert max(depth for time, depth in town.items() if time < 300.0) < 0.05
    assert max(town.values()) > 0.2
    through = column(out / "sections.csv", "discharge_m3_s", section="behind the levee")
    assert max(through[:25]) < 1.0
    assert max(through) > 15.0
    assert column(out / "structures.csv", "moved_m3", structure="road")[-1] > 100.0
    assert {"infiltration.tif", "arrival_0_1m.tif", "arrival_1m.tif"} <= {path.name for path in out.iterdir()}

    page = (EXAMPLES.parent / "docs" / "reference" / "results.md").read_text(encoding="utf-8")
    names = {path.name for path in out.iterdir() if not path.name.startswith("arrival_")}
    tables = [
        (out / f"{name}.csv").read_text().split("\n")[0] for name in ("gauges", "sections", "structures")
    ]
    columns = {column for table in tables for column in table.split(",")}
    told = {*names, *columns, *figures, *budget, *figures["smallest_mean_step"], *levee}
    assert not {word for word in told if f"`{word}`" not in page}


def test_the_how_to_page_shows_the_example_as_it_is() -> None:
    page = (EXAMPLES.parent / "docs" / "how_to" / "prepare_a_case.md").read_text(encoding="utf-8")
    case = (EXAMPLES / "levee_breach" / "case.toml").read_text(encoding="utf-8")

    assert f"```toml\n{case}```\n" in page
    files = {path.name for path in (EXAMPLES / "levee_breach").iterdir()} - {"case.toml"}
    assert not {name for name in files if f"`{name}`" not in page}
