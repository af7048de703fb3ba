import os
from pathlib import Path

import pytest

from solver_service.errors import RunError
from solver_service.offline.output_folder import output_folder


def listed(folder: Path) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*"))


def test_the_folder_appears_when_the_block_ends_well(tmp_path: Path) -> None:
    target = tmp_path / "deep" / "out"

    with output_folder(target) as scratch:
        (scratch / "a.txt").write_text("a")
        assert not target.exists()

    assert listed(tmp_path) == ["deep", "deep/out", "deep/out/a.txt"]
    assert os.stat(target).st_mode & 0o777 == 0o755


def fail(target: Path, error: Exception) -> None:
    with output_folder(target) as scratch:
        (scratch / "a.txt").write_text("half")
        raise error


def test_a_failure_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError):
        fail(tmp_path / "out", ZeroDivisionError())

    assert listed(tmp_path) == []


def test_a_full_disk_is_one_sentence_and_keeps_what_was_there(tmp_path: Path) -> None:
    target = tmp_path / "out"
    target.mkdir()
    (target / "a.txt").write_text("old")

    with pytest.raises(RunError, match=r"cannot be written to .*out': No space left on device; nothing was"):
        fail(target, OSError(28, "No space left on device"))

    assert listed(tmp_path) == ["out", "out/a.txt"]
    assert (target / "a.txt").read_text() == "old"


def test_files_and_folders_of_the_same_name_are_replaced_and_others_stay(tmp_path: Path) -> None:
    target = tmp_path / "out"
    (target / "t.zarr").mkdir(parents=True)
    for name in ("a.txt", "mine.txt", "t.zarr/old"):
        (target / name).write_text("old")

    with output_folder(target) as scratch:
        (scratch / "a.txt").write_text("new")
        (scratch / "t.zarr").mkdir()
        (scratch / "t.zarr" / "new").write_text("new")

    assert listed(target) == ["a.txt", "mine.txt", "t.zarr", "t.zarr/new"]
    assert (target / "a.txt").read_text() == "new"


def test_a_file_where_the_folder_should_be_is_refused(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")

    with pytest.raises(RunError, match="is a file; a folder is allowed"), output_folder(tmp_path / "out"):
        pass
    with pytest.raises(RunError, match="cannot be made"), output_folder(tmp_path / "out" / "below"):
        pass
