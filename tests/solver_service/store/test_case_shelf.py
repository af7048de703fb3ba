import os
from pathlib import Path

import msgspec
import pytest

from protocol import CaseSummary
from solver_service.errors import StoreError
from solver_service.store import CaseShelf, DataFolder, ShelvedCase, back_up
from tests.solver_service.store.small_store import SmallStore

SUMMARY = CaseSummary("river", "A river", False, 10, 20, 5.0, 100.0, 10.0)
SHELVED = ShelvedCase(SUMMARY, "0a1b2c3d", "Ada", 1e9, 0, ("It is odd.",))


@pytest.fixture
def folder(tmp_path: Path) -> DataFolder:
    return DataFolder(tmp_path / "data")


def put(folder: DataFolder, upload: str = "u1") -> ShelvedCase:
    """Put the case on the shelf as an import leaves it."""
    shelf = CaseShelf(folder)
    ready = shelf.begin(upload) / "shelf"
    (ready / "case" / "maps").mkdir(parents=True)
    (ready / "case" / "case.toml").write_text("x = 1")
    (ready / "case" / "maps" / "bed.asc").write_bytes(bytes(1000))
    return shelf.put(upload, ready, SHELVED)


def test_a_case_that_was_put_is_there_with_its_files_and_its_upload_is_gone(folder: DataFolder) -> None:
    shelved = put(folder)

    assert shelved == msgspec.structs.replace(SHELVED, size=1005)
    assert CaseShelf(DataFolder(folder.root)).cases() == [shelved]
    source = Path(CaseShelf(folder).source("river"))
    assert (source / "maps" / "bed.asc").stat().st_size == 1000
    assert not list((folder.root / "uploads").iterdir())


def test_a_second_case_of_a_name_is_refused_and_the_first_stays(folder: DataFolder) -> None:
    put(folder)
    with pytest.raises(StoreError, match="there is an uploaded case 'river' already"):
        put(folder, "u2")
    assert len(CaseShelf(folder).cases()) == 1


def test_a_link_among_the_files_is_refused(folder: DataFolder) -> None:
    shelf = CaseShelf(folder)
    ready = shelf.begin("u1") / "shelf"
    (ready / "case").mkdir(parents=True)
    os.symlink("/etc/passwd", ready / "case" / "case.toml")
    with pytest.raises(StoreError, match="is no plain file"):
        shelf.put("u1", ready, SHELVED)
    assert shelf.cases() == []


def test_a_removed_case_is_gone_at_once_and_one_that_is_not_there_is_told(folder: DataFolder) -> None:
    put(folder)
    CaseShelf(folder).remove("river")
    assert CaseShelf(folder).cases() == []
    assert not list((folder.root / "uploads").iterdir())
    with pytest.raises(StoreError, match="case river cannot be removed"):
        CaseShelf(folder).remove("river")


def test_a_start_removes_what_uploads_left(folder: DataFolder) -> None:
    put(folder)
    upload = CaseShelf(folder).begin("u2")
    (upload / "archive.zip").write_bytes(b"PK")
    folder.remove_unfinished()
    assert not upload.exists()
    assert len(CaseShelf(folder).cases()) == 1


@pytest.mark.parametrize("facts", [b"", b"{}", b'{"summary": 1}', None])
def test_a_case_whose_facts_are_broken_is_passed_over_with_a_word(
    folder: DataFolder, facts: bytes | None, caplog: pytest.LogCaptureFixture
) -> None:
    put(folder)
    broken = folder.case("lake")
    broken.mkdir()
    good = msgspec.json.encode(msgspec.structs.replace(SHELVED, size=5))
    (broken / "case.json").write_bytes(good if facts is None else facts)
    assert [shelved.summary.name for shelved in CaseShelf(folder).cases()] == ["river"]
    assert (facts is None) or "lake is not offered" in caplog.text


def test_a_backup_holds_the_uploaded_cases(store: SmallStore, tmp_path: Path) -> None:
    put(store.folder)
    CaseShelf(store.folder).begin("u7")
    back_up(store.folder, tmp_path / "copy")
    copy = DataFolder(tmp_path / "copy")
    assert CaseShelf(copy).cases() == CaseShelf(store.folder).cases()
    assert (Path(CaseShelf(copy).source("river")) / "maps" / "bed.asc").stat().st_size == 1000
    assert not list((copy.root / "uploads").iterdir())
