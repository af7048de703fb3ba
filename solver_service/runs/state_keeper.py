"""Background keeper of full-precision states: packs those in memory, writes those meant for the disk."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable

from solver_service.errors import StoreError
from solver_service.runs.state_ring import StateRing
from solver_service.runs.worker_messages import CheckpointStored, Remark
from solver_service.store import CheckpointStore, DataFolder, RunDatabase, StoredState


class StateKeeper:
    """Owns the ring of recent states and the thread that writes checkpoints."""

    def __init__(
        self,
        folder: DataFolder,
        epoch: int,
        ring_bytes: int,
        report: Callable[[CheckpointStored | Remark], None],
    ) -> None:
        """Start the thread.

        Args:
            folder: the data folder.
            epoch: epoch of the service.
            ring_bytes: memory for recent states [bytes].
            report: called with each stored checkpoint, and with a remark when one cannot be stored.
        """
        self.ring = StateRing(ring_bytes)
        self._folder = folder
        self._epoch = epoch
        self._report = report
        self._wake = threading.Condition()
        self._to_disk: deque[tuple[str, StoredState | None, Callable[[], None] | None]] = deque()
        self._unpacked = False
        self._closing = False
        self._thread = threading.Thread(target=self._work, name="state-keeper", daemon=True)
        self._thread.start()

    def remember(self, run: str, state: StoredState) -> None:
        """Keep a state in memory."""
        self.ring.add(run, state)
        with self._wake:
            self._unpacked = True
            self._wake.notify_all()

    def checkpoint(self, run: str, state: StoredState, then: Callable[[], None] | None = None) -> None:
        """Write a state to disk soon; a failure is a remark, for the run itself is not harmed.

        Args:
            run: the run.
            state: its state.
            then: called by the thread of the keeper once the state is stored or refused.
        """
        with self._wake:
            # a disk that is slower than the solver gets the newest state of a run, not a growing queue
            waiting = [job for job in self._to_disk if job[0] != run or job[2] is not None]
            self._to_disk = deque([*waiting, (run, state, then)])
            self._wake.notify_all()

    def then(self, call: Callable[[], None]) -> None:
        """Have something called once every state meant for the disk so far is there (or was refused)."""
        with self._wake:
            self._to_disk.append(("", None, call))
            self._wake.notify_all()

    def close(self) -> None:
        """Write what waits for the disk, then end the thread."""
        with self._wake:
            self._closing = True
            self._wake.notify_all()
        self._thread.join()

    def _work(self) -> None:
        database = RunDatabase(self._folder.database, self._epoch)
        store = CheckpointStore(self._folder, database)
        while True:
            with self._wake:
                self._wake.wait_for(lambda: bool(self._to_disk) or self._unpacked or self._closing)
                job = self._to_disk.popleft() if self._to_disk else None
                if job is None and self._closing:
                    break
                self._unpacked = self._unpacked and job is not None
            if job is None:
                if self.ring.pack_one():
                    with self._wake:
                        self._unpacked = True
                continue
            run, state, then = job
            if state is not None:
                try:
                    self._report(CheckpointStored(store.write(run, state)))
                except StoreError as error:
                    self._report(Remark(run, str(error)))
            if then is not None:
                then()
        database.close()
