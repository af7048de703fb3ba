"""Commands to the service and what becomes of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import protocol
from viewer.net import ConnectionThread, NotConnected

__all__ = ["Reply", "ServiceLink"]

Reply = Callable[[Mapping[str, object]], None]
Refusal = Callable[[str], None]


@dataclass(frozen=True)
class _Waiting:
    what: str
    done: Reply | None
    refused: Refusal | None


class ServiceLink:
    """Sends commands, remembers what to do when each is answered.

    Args:
        connection: the connection that carries them.
        complain: shows a sentence to the user.
    """

    def __init__(self, connection: ConnectionThread, complain: Callable[[str], None]) -> None:
        self._connection = connection
        self._complain = complain
        self._waiting: dict[int, _Waiting] = {}

    def send(
        self,
        make: Callable[[int], protocol.ClientMessage],
        what: str,
        done: Reply | None = None,
        refused: Refusal | None = None,
    ) -> bool:
        """Send the command that `make` builds around a fresh id; return whether it left.

        Args:
            make: from a command id to the message.
            what: the command in words, for complaints.
            done: called with the result once the service has carried it out.
            refused: called with the reason when it was not (the user is told in any case).
        """
        number = self._connection.next_id()
        self._waiting[number] = _Waiting(what, done, refused)
        try:
            self._connection.send(make(number))
        except NotConnected as error:
            self._fail(number, str(error))
            return False
        return True

    def grant(self, frames: int) -> None:
        """Let the service send so many more frames."""
        try:
            while frames > 0:
                share = min(frames, protocol.limits.MAX_CREDIT)
                self._connection.send(protocol.Credit(share))
                frames -= share
        except NotConnected:
            return  # a new connection begins with new credit

    def handle_ack(self, ack: protocol.Ack) -> None:
        """A command was carried out."""
        waiting = self._waiting.pop(ack.id, None)
        if waiting is not None and waiting.done is not None:
            waiting.done(ack.result)

    def handle_listing(self, number: int) -> None:
        """A command was answered by a message of its own kind."""
        self._waiting.pop(number, None)

    def handle_error(self, error: protocol.Error) -> None:
        """A command was refused, or the service has something against this connection."""
        if error.id is None:
            self._complain(error.message)
        else:
            self._fail(error.id, error.message)

    def forget(self) -> None:
        """The connection was lost: nothing sent before will be answered any more."""
        for number in list(self._waiting):
            self._fail(number, "the connection was lost before the service answered")

    def _fail(self, number: int, reason: str) -> None:
        waiting = self._waiting.pop(number, None)
        if waiting is None:
            return
        self._complain(f"{waiting.what}: {reason}")
        if waiting.refused is not None:
            waiting.refused(reason)
