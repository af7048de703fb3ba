"""The store on a thread of its own, so that the event loop never waits for a disk."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Concatenate, ParamSpec, TypeVar

from solver_service.store import DataFolder, RunDatabase

LOG = logging.getLogger(__name__)

P = ParamSpec("P")
T = TypeVar("T")


class StoreThread:
    """Calls methods of a `RunDatabase` in order on its own thread."""

    def __init__(self, folder: DataFolder) -> None:
        """Open the database of a folder.

        Raises:
            StoreError: it cannot be opened.
        """
        self._executor = ThreadPoolExecutor(1, thread_name_prefix="store")
        self._database = self._executor.submit(RunDatabase, folder.database).result()

    async def call(
        self, method: Callable[Concatenate[RunDatabase, P], T], *args: P.args, **kwargs: P.kwargs
    ) -> T:
        """Call a method and wait for what it gives.

        Raises:
            StoreError: what the method raises.
        """
        future = self._executor.submit(method, self._database, *args, **kwargs)
        return await asyncio.wrap_future(future)

    def later(
        self, method: Callable[Concatenate[RunDatabase, P], T], *args: P.args, **kwargs: P.kwargs
    ) -> None:
        """Call a method in its turn without waiting; a failure is logged."""
        self._executor.submit(method, self._database, *args, **kwargs).add_done_callback(_log_failure)

    def close(self) -> None:
        """Finish what was asked for and close."""
        self._executor.submit(self._database.close).result()
        self._executor.shutdown()


def _log_failure(future: Future[T]) -> None:
    error = future.exception()
    if error is not None:
        LOG.error("%s", error)
