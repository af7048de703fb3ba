"""Hand-over between the connection thread and the thread that draws.

Two planes. Control messages are few and never dropped: a full control plane is an error that ends the
connection
with a reason. Frames are many and any of them can be fetched again by its index, so beyond their bound the
oldest waiting one gives way to the newest. (With credits the bound is not reached.)
"""

from __future__ import annotations

import threading
from collections import deque
from typing import Generic, TypeVar

__all__ = ["Mailbox", "MailboxFull"]

Control = TypeVar("Control")
Data = TypeVar("Data")

CONTROL_LIMIT = 4096
FRAME_LIMIT = 64


class MailboxFull(Exception):
    """The reader has not taken a control message for so long that no more fit."""


class Mailbox(Generic[Control, Data]):
    """A bounded two-plane box that one thread fills and another empties.

    Args:
        control_limit: number of control messages that may wait.
        frame_limit: number of frames that may wait.
    """

    def __init__(self, control_limit: int = CONTROL_LIMIT, frame_limit: int = FRAME_LIMIT) -> None:
        self._control: deque[Control] = deque()
        self._control_limit = control_limit
        self._frames: deque[Data] = deque(maxlen=frame_limit)
        self._lock = threading.Lock()
        self._filled = threading.Condition(self._lock)
        self.dropped_frames = 0

    def put_control(self, message: Control) -> None:
        """Add a control message.

        Raises:
            MailboxFull: `control_limit` messages wait already.
        """
        with self._lock:
            if len(self._control) >= self._control_limit:
                raise MailboxFull(f"{len(self._control)} control messages wait and nobody takes them")
            self._control.append(message)
            self._filled.notify_all()

    def put_frame(self, frame: Data) -> None:
        """Add a frame; the oldest waiting one is dropped when the box is full."""
        with self._lock:
            if len(self._frames) == self._frames.maxlen:
                self.dropped_frames += 1
            self._frames.append(frame)
            self._filled.notify_all()

    def take_control(self) -> list[Control]:
        """Return all waiting control messages in the order they came."""
        with self._lock:
            messages = list(self._control)
            self._control.clear()
            return messages

    def take_frames(self, limit: int | None = None) -> list[Data]:
        """Return waiting frames in the order they came, at most `limit` of them."""
        with self._lock:
            count = len(self._frames) if limit is None else min(limit, len(self._frames))
            return [self._frames.popleft() for _ in range(count)]

    def wait(self, timeout_s: float) -> bool:
        """Wait until something lies in the box, at most `timeout_s`; return whether something does."""
        with self._lock:
            return self._filled.wait_for(lambda: bool(self._control or self._frames), timeout_s)
