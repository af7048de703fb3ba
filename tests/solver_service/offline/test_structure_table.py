from pathlib import Path

import pytest

from solver_service.offline import OfflineOptions, run_case
from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, rows_of, write_case

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
    assert last["dam"]["discharge_m3_s"] == ""
