from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.solver_service.store.small_store import SmallStore


@pytest.fixture
def store(tmp_path: Path) -> Iterator[SmallStore]:
    store = SmallStore(tmp_path / "data")
    yield store
    store.database.close()
