from pathlib import Path

import pytest

from solver_service.cli.event_log import replay_log, write_log
from solver_service.errors import StoreError
from tests.solver_service.store.small_store import SmallStore


def test_the_log_of_a_stored_run_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    store = SmallStore(tmp_path / "data")
    store.database.close()
    write_log("r2", tmp_path / "run.jsonl", store.folder.root)
    lines = (tmp_path / "run.jsonl").read_text().splitlines()
    assert lines[0].startswith('{"type":"run","run":"r2"')
    assert sum('"type":"frame"' in line for line in lines) == 6
    write_log("r2", None, store.folder.root)
    assert capsys.readouterr().out.splitlines() == lines


def test_what_is_not_there_is_refused_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="holds no runs"):
        write_log("r1", None, tmp_path)
    store = SmallStore(tmp_path / "data")
    store.database.close()
    with pytest.raises(StoreError, match="there is no run 'r9'; there are r1, r2"):
        write_log("r9", None, store.folder.root)
    with pytest.raises(StoreError, match="cannot be written"):
        write_log("r1", tmp_path / "no" / "folder", store.folder.root)
    with pytest.raises(StoreError, match="cannot be read"):
        replay_log(tmp_path / "absent.jsonl", None, None)
