from pathlib import Path

import pytest

from solver_service.cli.store import backup_store, check_store, repair_store
from solver_service.errors import StoreError
from solver_service.store import DataFolder
from tests.solver_service.store.small_store import SmallStore


@pytest.fixture
def data_dir(tmp_path: Path) -> Path:
    store = SmallStore(tmp_path / "data")
    store.database.close()
    return store.folder.root


def damage(data_dir: Path) -> None:
    segment = sorted((data_dir / "frames" / "r1").glob("*.segment"))[7]
    segment.write_bytes(b"\xff" + segment.read_bytes()[1:])  # its frame comes first, channels behind it


def test_check_tells_what_is_wrong_and_repair_mends_it(
    data_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert check_store(data_dir)
    assert "2 runs, 0 faults" in capsys.readouterr().out
    damage(data_dir)
    assert not check_store(data_dir)
    assert "frame 7 of run r1 is damaged" in capsys.readouterr().out
    assert repair_store(data_dir)
    assert "mended: forgot 33 frames of run r1 from index 7 on" in capsys.readouterr().out
    assert check_store(data_dir)


def test_a_folder_in_use_is_checked_but_not_repaired(
    data_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with DataFolder(data_dir):
        assert check_store(data_dir)
        assert "a service uses it" in capsys.readouterr().out
        with pytest.raises(StoreError, match="in use by another service"):
            repair_store(data_dir)


def test_a_backup_is_a_store_again(
    data_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with DataFolder(data_dir):
        backup_store(tmp_path / "copy", data_dir)
    assert "copied to" in capsys.readouterr().out
    assert check_store(tmp_path / "copy")


def test_a_folder_without_runs_is_refused(tmp_path: Path) -> None:
    for command in (check_store, repair_store, lambda folder: backup_store(tmp_path / "copy", folder)):
        with pytest.raises(StoreError, match="holds no runs"):
            command(tmp_path)
