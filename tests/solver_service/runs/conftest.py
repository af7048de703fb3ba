import asyncio
import threading
import time
from collections.abc import Callable, Coroutine, Iterator
from pathlib import Path
from typing import Any, TypeVar

import pytest

from protocol import Notice, RunChanged, ServerMessage
from solver_service.runs import RoomRules, Run, RunRegistry, RunStatus
from tests.end_to_end.dam_break import write_dam_break

T = TypeVar("T")
PATIENCE_S = 60.0


class Service:
    """A registry with its workers on an event loop of its own thread, and what it announced."""

    def __init__(self, data_dir: Path, **options: Any) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever)
        self._thread.start()
        self.heard: list[ServerMessage] = []
        self._news = threading.Condition()
        options.setdefault("room", RoomRules(interval_s=0.2))
        self.registry = RunRegistry(data_dir, **options)
        self.registry.audience.add(self)
        self.call(self.registry.open())

    def call(self, coroutine: Coroutine[Any, Any, T]) -> T:
        """Do something on the event loop."""
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result(PATIENCE_S)

    def announce(self, message: ServerMessage) -> None:
        with self._news:
            self.heard.append(message)
            self._news.notify_all()

    def frame_stored(self, run: str) -> None:
        with self._news:
            self._news.notify_all()

    def wait(self, test: Callable[[], bool]) -> None:
        """Wait until something is so."""
        ends = time.monotonic() + PATIENCE_S
        with self._news:  # not everything that is waited for is announced
            while not self._news.wait_for(test, 0.1):
                assert time.monotonic() < ends, "it did not come"

    def wait_for_status(self, run: Run, status: RunStatus) -> None:
        self.wait(lambda: run.status is status)

    def notices(self, run: str) -> list[str]:
        return [m.text for m in self.heard if isinstance(m, Notice) and m.run == run]

    def statuses(self, run: str) -> list[str]:
        """The statuses a run went through."""
        found = [m.run.status for m in self.heard if isinstance(m, RunChanged) and m.run.run == run]
        return [s for i, s in enumerate(found) if i == 0 or found[i - 1] != s]

    def close(self) -> None:
        self.call(self.registry.close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()


@pytest.fixture(scope="session")
def case(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(write_dam_break(tmp_path_factory.mktemp("case") / "dam-break"))


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory, case: str) -> Iterator[Service]:
    data_dir = tmp_path_factory.mktemp("data")
    service = Service(data_dir, cases=(case,), threads=2, checkpoint_interval_s=0.02)
    yield service
    service.close()
