"""Which sessions show their view to the others."""

from __future__ import annotations

import time
from collections.abc import Callable

from protocol import ServerMessage, View, ViewPresented
from protocol.limits import MAX_VIEWS_PER_S
from solver_service.errors import RunError
from solver_service.runs.controllers import Session


class Presentations:
    """The newest view of every session that presents; lives on the event loop."""

    def __init__(
        self, announce: Callable[[ServerMessage], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        """Nobody presents.

        Args:
            announce: tells everybody.
            clock: gives the time now [s].
        """
        self._announce = announce
        self._clock = clock
        self._shown: dict[str, ViewPresented] = {}
        self._last: dict[str, float] = {}

    @property
    def current(self) -> tuple[ViewPresented, ...]:
        """The newest view of each presenter, for whoever comes later."""
        return tuple(self._shown.values())

    def present(self, session: Session, view: View | None) -> None:
        """Show a view to everybody; None ends the presentation.

        Raises:
            RunError: the session shows views faster than all others can be told.
        """
        now = self._clock()
        if view is None:
            self.ended(session.session)
            return
        if now - self._last.get(session.session, float("-inf")) < 1.0 / MAX_VIEWS_PER_S:
            raise RunError(f"{session} presents views too fast; {MAX_VIEWS_PER_S} a second are allowed")
        self._last[session.session] = now
        message = ViewPresented(session.session, session.client, view)
        self._shown[session.session] = message
        self._announce(message)

    def ended(self, session: str) -> None:
        """A session presents no more, or its connection is over."""
        self._last.pop(session, None)
        if (message := self._shown.pop(session, None)) is not None:
            self._announce(ViewPresented(session, message.client))
