from pathlib import Path

import pytest

from solver_service.offline import OfflineOptions, run_case
from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, GAUGES, rows_of, write_case

PIPE = '\n[[culvert]]\nid = "pipe, a"\ninlet = [1055.0, 2125.0]\noutlet = [1305.0, 2125.0]\ndiameter = 1.0\n'
PUMP = '\n[[pump]]\nid = "pump"\ninlet = [1025.0, 2125.0]\ndischarge = 3.0\n'
BREACH = """
[[breach]]
id = "dam"
line = [[1105.0, 2085.0], [1105.0, 2155.0]]
start_time = 10.0
bottom_level = 301.0
duration = 5.0
width_final = 40.0
crest = 305.0
"""


def test_structures_are_recorded_at_every_output_time(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path / "case", CASE + PIPE + PUMP + BREACH))

    summary = run_case(case, OfflineOptions(device="cpu", out=tmp_path / "out"))

    rows = rows_of(tmp_path / "out" / "structures.csv")
    assert len(rows) == 5 * 3
    assert {row["structure"] for row in rows} == {"pipe, a", "pump", "dam"}
    last = {row["structure"]: row for row in rows[-3:]}
    assert float(last["pump"]["moved_m3"]) == pytest.approx(60.0, rel=0.02)
    assert float(last["pump"]["discharge_m3_s"]) == pytest.approx(3.0, rel=0.02)
    assert summary["water_budget_m3"]["structures"]["pump"] == pytest.approx(60.0, rel=0.02)
    assert 0.0 < float(last["pipe, a"]["discharge_m3_s"]) < 10.0
    widths = [float(row["width_m"]) for row in rows if row["structure"] == "dam"]
    assert widths[:2] == [0.0, 0.0]
    assert widths[-1] == 40.0
    assert float(last["dam"]["level_m"]) == pytest.approx(301.0, abs=1e-3)
    # The line runs north: its right is the east, where the water goes.
    assert float(last["dam"]["discharge_m3_s"]) > 10.0
    through = [float(row["moved_m3"]) for row in rows if row["structure"] == "dam"]
    assert through == sorted(through)


def test_what_passes_a_weir_is_told(tmp_path: Path) -> None:
    wall = '\n[[weir]]\nid = "wall"\nline = [[1100.0, 2000.0], [1100.0, 2240.0]]\ncrest = 305.0\n'
    case = load_case(write_case(tmp_path / "case", CASE + wall + GAUGES))

    summary = run_case(case, OfflineOptions(device="cpu", out=tmp_path / "out"))

    rows = rows_of(tmp_path / "out" / "structures.csv")
    assert [row["time_s"] for row in rows] == ["0", "5", "10", "15", "20"]
    moved = [float(row["moved_m3"]) for row in rows]
    assert moved[-1] > 100.0
    assert float(rows[-1]["discharge_m3_s"]) == pytest.approx((moved[-1] - moved[-2]) / 5.0, rel=1e-4)
    # The section of the case runs the same line the other way.
    (dam,) = summary["sections"]
    assert dam["volume_m3"] == pytest.approx(-moved[-1], rel=1e-6)
    assert {row["section"] for row in rows_of(tmp_path / "out" / "sections.csv")} == {"dam"}
