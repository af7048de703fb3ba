"""Who hears what the service has to say: connections listen, runs speak."""

from __future__ import annotations

from typing import Protocol

from protocol import ServerMessage


class Listener(Protocol):
    """Somebody who wants to hear; called on the event loop and must not wait."""

    def announce(self, message: ServerMessage) -> None:
        """A message that is meant for all who care."""

    def frame_stored(self, run: str) -> None:
        """A run has one frame more."""


class Audience:
    """All listeners."""

    def __init__(self) -> None:
        self._listeners: set[Listener] = set()

    def __len__(self) -> int:
        return len(self._listeners)

    def add(self, listener: Listener) -> None:
        """Let somebody hear from now on."""
        self._listeners.add(listener)

    def remove(self, listener: Listener) -> None:
        """Let somebody hear no more."""
        self._listeners.discard(listener)

    def announce(self, message: ServerMessage) -> None:
        """Tell everybody."""
        for listener in tuple(self._listeners):
            listener.announce(message)

    def frame_stored(self, run: str) -> None:
        """Tell everybody that a run has one frame more."""
        for listener in tuple(self._listeners):
            listener.frame_stored(run)
