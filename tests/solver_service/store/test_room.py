import errno
import sqlite3
from pathlib import Path

import pytest

from solver_service.errors import StoreError, StoreFull
from solver_service.store import DataFolder
from solver_service.store.room import free_bytes, has_room, store_failure


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EFBIG, errno.EDQUOT])
def test_a_disk_a_quota_and_a_file_limit_that_are_full_are_told_from_a_broken_disk(number: int) -> None:
    assert isinstance(store_failure(OSError(number, "full"), "frame 1 cannot be stored"), StoreFull)
    broken = store_failure(OSError(errno.EIO, "Input/output error"), "frame 1 cannot be stored")
    assert type(broken) is StoreError
    assert str(broken) == "frame 1 cannot be stored: Input/output error"


def test_a_full_database_is_told_from_a_locked_one(tmp_path: Path) -> None:
    database = sqlite3.connect(tmp_path / "small.sqlite")
    database.execute("PRAGMA max_page_count = 2")
    database.execute("CREATE TABLE words (word TEXT)")
    with pytest.raises(sqlite3.Error) as full:
        database.execute("INSERT INTO words VALUES (?)", ("x" * 100_000,))
    database.close()
    assert isinstance(store_failure(full.value, "store"), StoreFull)
    assert type(store_failure(sqlite3.OperationalError("database is locked"), "store")) is StoreError


def test_room_is_tried_by_writing_and_leaves_nothing(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    folder = DataFolder(tmp_path)
    before = sorted(path.name for path in tmp_path.iterdir())
    assert has_room(folder, 3_000_000)
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, limit[1]))
    try:
        assert not has_room(folder, 3_000_000)
        assert has_room(folder, 500_000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    assert sorted(path.name for path in tmp_path.iterdir()) == before
    assert free_bytes(folder) > 0
