"""Commands on their way to the solver thread: read by a thread, looked at between two steps."""

from __future__ import annotations

import queue
import threading
from multiprocessing.connection import Connection

from solver_service.runs.worker_messages import Command, Quit


class Inbox:
    """Reads the pipe of a worker; the end of the pipe (the service is gone) counts as Quit.

    Attributes:
        quitting: whether Quit has come, although commands before it may still wait.
    """

    def __init__(self, connection: Connection) -> None:
        """Start reading.

        Args:
            connection: the worker's end of the pipe.
        """
        self._connection = connection
        self._commands: queue.SimpleQueue[Command] = queue.SimpleQueue()
        self.quitting = False
        threading.Thread(target=self._read, name="worker-inbox", daemon=True).start()

    @property
    def pending(self) -> bool:
        """Whether a command waits; cheap enough to be asked at every step."""
        return not self._commands.empty()

    def next(self, wait: bool) -> Command | None:
        """The next command; None when there is none and `wait` is False."""
        try:
            return self._commands.get(block=wait)
        except queue.Empty:
            return None

    def _read(self) -> None:
        try:
            while True:
                command = self._connection.recv()
                self.quitting = isinstance(command, Quit)
                self._commands.put(command)
        except (EOFError, OSError):
            self.quitting = True
            self._commands.put(Quit())
