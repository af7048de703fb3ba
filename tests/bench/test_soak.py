"""A small dose of `python -m bench soak`, whose half an hour is kept in bench/results."""

import os
from pathlib import Path

import pytest

from bench.soak import SMOKE_ALLOWED, Allowed, Sampler, remains, soak
from solver_service.store import DataFolder, RunDatabase


@pytest.mark.slow
def test_five_seconds_of_everything_leave_nothing_behind_and_nothing_grows(tmp_path: Path) -> None:
    lines = {str(line["figure"]): line for line in soak(tmp_path, 5.0, SMOKE_ALLOWED)}
    assert [name for name, line in lines.items() if line.get("grows")] == []
    assert lines["runs_left"]["value"] == 0
    assert lines["files_without_a_row"]["value"] == 0
    for name in ("runs", "edits", "recalculations", "deletions", "visits"):
        assert int(str(lines[name]["value"])) > 0, f"no {name}: nothing was tried"


def test_what_grows_and_what_is_left_behind_is_found(tmp_path: Path) -> None:
    sampler = Sampler(os.getpid())
    sampler.times = [float(k) for k in range(200)]
    sampler.values = {"service_memory": [1e6 * k for k in range(200)], "service_files": [7.0] * 200}
    grows = {line["figure"]: line["grows"] for line in sampler.growth(Allowed(20e6, 4.0, 2.0))}
    assert grows == {"service_memory_growth": True, "service_files_growth": False}
    folder = DataFolder(tmp_path)
    RunDatabase(folder.database).close()
    assert remains(tmp_path) == []
    folder.frames("gone").mkdir()
    (folder.frames("gone") / "000001.segment").write_bytes(b"frame")
    assert "belongs to no run" in remains(tmp_path)[0]
