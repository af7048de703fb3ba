"""Commands on their way to the solver thread: read by a thread, looked at between two steps."""

from __future__ import annotations

import queue
import threading
from multiprocessing.connection import Connection

from solver_service.runs.worker_messages import Command, Quit


class Inbox:
    """Reads the pipe of a worker; the end of the pipe (the service is gone) counts as Quit.

    Attributes:
        looks: how often the solver thread has looked here, as it does between two steps and two commands.
        is_waited_for: whether the solver thread waits here for a command.
    """

    def __init__(self, connection: Connection) -> None:
        """Start reading.

        Args:
            connection: the worker's end of the pipe.
        """
        self._connection = connection
        self._commands: queue.SimpleQueue[Command] = queue.SimpleQueue()
        self._quitting = False
        self.looks = 0
        self.is_waited_for = False
        threading.Thread(target=self._read, name="worker-inbox", daemon=True).start()

    @property
    def quitting(self) -> bool:
        """Whether Quit has come, although commands before it may still wait."""
        self.looks += 1
        return self._quitting

    @property
    def pending(self) -> bool:
        """Whether a command waits; cheap enough to be asked at every step."""
        self.looks += 1
        return not self._commands.empty()

    def next(self, wait: bool) -> Command | None:
        """The next command; None when there is none and `wait` is False."""
        self.looks += 1
        self.is_waited_for = wait
        try:
            return self._commands.get(block=wait)
        except queue.Empty:
            return None
        finally:
            self.is_waited_for = False

    def _read(self) -> None:
        try:
            while True:
                command = self._connection.recv()
                self._quitting = isinstance(command, Quit)
                self._commands.put(command)
        except (EOFError, OSError):
            self._quitting = True
            self._commands.put(Quit())
