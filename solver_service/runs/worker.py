"""A worker as the event loop sees it: send commands, hear reports, notice its death at once."""

from __future__ import annotations

import asyncio
import itertools
import logging
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess

from solver_service.errors import RunError
from solver_service.runs.native_lines import tell_lines
from solver_service.runs.worker_failure import FailureKind, failure_of_exit
from solver_service.runs.worker_messages import (
    Begin,
    CaseLoaded,
    CaseRefused,
    Command,
    Failed,
    Left,
    LoadCase,
    Pulse,
    Quit,
    Ready,
    Report,
    SaveState,
    StateSaved,
    Unfit,
    WorkerSettings,
)
from solver_service.runs.worker_process import start_worker

LOG = logging.getLogger(__name__)

QUIT_TIMEOUT_S = 3.0
_numbers = itertools.count(1)


class Worker:
    """One worker process.

    Attributes:
        number: for logs.
        run: id of the run it computes or holds, None for a spare one.
        devices: devices it can use, once it is ready.
        case: case and device it has loaded, None for none.
        holds: runs of which something may still be on its way from this worker to the disk, with the number
            of the last Begin of each.
        pulse_at: when the last pulse came, or the process was started (monotonic clock) [s].
        advanced_at: when its solver thread was last seen to go on, or to wait for orders [s].
        has_pulse: whether a pulse ever came.
        is_ending: whether it was told to end, or will be; such a worker takes no run.
    """

    def __init__(
        self, on_report: Callable[[Worker, Report], None], on_death: Callable[[Worker], None]
    ) -> None:
        """A worker that is not started yet.

        Args:
            on_report: called on the event loop with every report of a run.
            on_death: called on the event loop when the process is gone, for whatever reason.
        """
        self.number = next(_numbers)
        self.run: str | None = None
        self.devices: tuple[str, ...] = ()
        self.case: tuple[str, str] | None = None
        self.holds: dict[str, int] = {}
        self.is_ending = False
        self.pid: int | None = None
        self.pulse_at = self.advanced_at = time.monotonic()
        self.has_pulse = False
        self._looks = 0
        self._last_words: Failed | None = None
        self._on_report = on_report
        self._on_death = on_death
        self._unfit = ""
        self._ready = asyncio.Event()
        self._dead = asyncio.Event()
        self._loaded: asyncio.Future[CaseLoaded] | None = None
        self._saved: asyncio.Future[bool] | None = None
        self._process: BaseProcess | None = None
        self._connection: Connection | None = None

    @property
    def is_ready(self) -> bool:
        """Whether its kernels are loaded and it lives."""
        return self._ready.is_set() and not self._dead.is_set()

    @property
    def is_dead(self) -> bool:
        """Whether the process is gone."""
        return self._dead.is_set()

    async def start(self, settings: WorkerSettings) -> None:
        """Start the process and the threads that listen to it."""
        loop = asyncio.get_running_loop()
        process, connection, errors = await asyncio.to_thread(start_worker, settings)
        self._process, self._connection = process, connection
        self.pid = process.pid
        threading.Thread(
            target=tell_lines, args=(errors, lambda: self.run), name=f"lines-{self.number}", daemon=True
        ).start()
        threading.Thread(
            target=self._listen, args=(loop, connection), name=f"worker-{self.number}", daemon=True
        ).start()

    async def ready(self) -> None:
        """Wait until the kernels are loaded.

        Raises:
            RunError: the worker died instead.
        """
        waits = [asyncio.ensure_future(event.wait()) for event in (self._ready, self._dead)]
        await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
        for wait in waits:
            wait.cancel()
        if self._dead.is_set():
            raise RunError(self._unfit or "a worker process ended while it was starting")

    def send(self, command: Command) -> None:
        """Tell it something; a dead worker hears nothing, and its death is told by `on_death`."""
        if self._connection is not None and not self._dead.is_set():
            if isinstance(command, Begin):
                self.holds[command.run] = command.number
            try:
                self._connection.send(command)
            except OSError:
                return  # the listening thread sees the same and tells it

    async def load(self, case: str, device: str) -> CaseLoaded:
        """Load a case.

        Raises:
            RunError: the case or the device cannot be used; the sentence is the worker's.
        """
        self._loaded = asyncio.get_running_loop().create_future()
        self.send(LoadCase(case, device))
        loaded = await self._loaded
        self.case = (case, device)
        return loaded

    async def save_state(self, run: str, index: int) -> bool:
        """Have a state put on disk; False when the worker does not hold it."""
        self._saved = asyncio.get_running_loop().create_future()
        self.send(SaveState(run, index))
        return await self._saved

    async def quit(self) -> None:
        """End it: politely, then not; one that is still starting has nothing to lose."""
        self.is_ending = True
        if not self._ready.is_set():
            self.kill()
        self.send(Quit())
        try:
            await asyncio.wait_for(self._dead.wait(), QUIT_TIMEOUT_S)
        except TimeoutError:
            self.kill()
            await self._dead.wait()

    @property
    def cause_of_death(self) -> tuple[FailureKind, str]:
        """Why the process is gone: what it said itself, else what its exit status means."""
        if self._last_words is not None:
            return self._last_words.kind, self._last_words.message
        return failure_of_exit(self._process.exitcode if self._process is not None else None)

    def give_up(self, kind: FailureKind, words: str) -> None:
        """End the process at once, for a reason that is then the cause of its death."""
        self._last_words = Failed(self.run or "", kind, words, ending=True)
        self.kill()

    def kill(self) -> None:
        """End the process at once."""
        if self._process is not None:
            self._process.kill()

    def _listen(self, loop: asyncio.AbstractEventLoop, connection: Connection) -> None:
        try:
            while True:
                report = connection.recv()
                loop.call_soon_threadsafe(self._hear, report)
        except (EOFError, OSError):
            pass
        if self._process is not None:
            self._process.join()
        connection.close()
        if not loop.is_closed():
            loop.call_soon_threadsafe(self._end)

    def _hear(self, report: Report) -> None:
        match report:
            case Pulse():
                self._feel(report)
            case Ready():
                self.advanced_at = time.monotonic()
                self.devices = report.devices
                self._ready.set()
            case Unfit():
                self._unfit = report.message
                LOG.error("worker %d: %s", self.number, report.message)
            case CaseLoaded():
                if self._loaded is not None and not self._loaded.done():
                    self._loaded.set_result(report)
            case CaseRefused():
                if self._loaded is not None and not self._loaded.done():
                    self._loaded.set_exception(RunError(report.message))
            case StateSaved():
                if self._saved is not None and not self._saved.done():
                    self._saved.set_result(report.ok)
            case Failed(ending=True):
                self._last_words = report  # told with its death, which comes at once
            case Left():
                if self.holds.get(report.run) == report.number:
                    del self.holds[report.run]
                self._on_report(self, report)
            case _:
                self._on_report(self, report)

    def _feel(self, pulse: Pulse) -> None:
        self.has_pulse = True
        self.pulse_at = time.monotonic()
        if pulse.waits or pulse.looks != self._looks:
            self.advanced_at = self.pulse_at
        self._looks = pulse.looks

    def _end(self) -> None:
        self._dead.set()
        self.holds.clear()
        gone = RunError(f"nothing was done: {self.cause_of_death[1]}")
        if self._loaded is not None and not self._loaded.done():
            self._loaded.set_exception(gone)
        if self._saved is not None and not self._saved.done():
            self._saved.set_result(False)
        self._on_death(self)
