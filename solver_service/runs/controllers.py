"""Who may change a run: one session at a time controls it, all others follow.

A command that changes a run nobody controls takes control by itself. A controller hands over by releasing
control to another session, loses it when its connection ends, and can be taken over once it has sent no
command for `IDLE_S`, or by force; whoever is lost or refused is told.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from protocol import ControlChanged, ControlRequested, ServerMessage
from solver_service.errors import RunError

IDLE_S = 30.0


@dataclass(frozen=True)
class Session:
    """A connection as the others see it.

    Attributes:
        session: its id.
        client: name of its client program.
    """

    session: str
    client: str = ""

    def __str__(self) -> str:
        """For sentences."""
        return f"session {self.session}" + (f" ({self.client})" if self.client else "")


@dataclass
class _Control:
    holder: Session
    last_command: float


class Controllers:
    """The controllers of all runs; lives on the event loop."""

    def __init__(
        self, announce: Callable[[ServerMessage], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        """No run has a controller.

        Args:
            announce: tells everybody; who does not care for the run, or is not meant, drops it.
            clock: gives the time now [s].
        """
        self._announce = announce
        self._clock = clock
        self._controls: dict[str, _Control] = {}

    def of(self, run: str) -> ControlChanged:
        """Who controls a run, as it is told."""
        control = self._controls.get(run)
        if control is None:
            return ControlChanged(run)
        return ControlChanged(run, control.holder.session, control.holder.client)

    def claim(self, run: str, session: Session) -> None:
        """Let a session change a run, which takes control where nobody has it.

        Raises:
            RunError: another session controls it.
        """
        control = self._controls.get(run)
        if control is None:
            self._set(run, session)
        elif control.holder.session == session.session:
            control.last_command = self._clock()
        else:
            raise RunError(f"run {run} is controlled by {control.holder}; take control of it first")

    def take(self, run: str, session: Session, force: bool) -> None:
        """Give the control of a run to whoever asks.

        Raises:
            RunError: its controller is active.
        """
        control = self._controls.get(run)
        if control is not None and control.holder.session != session.session and not force:
            idle_s = self._clock() - control.last_command
            if idle_s < IDLE_S:
                self._announce(ControlRequested(run, session.session, session.client))
                raise RunError(
                    f"run {run} is controlled by {control.holder}, active {idle_s:.0f} s ago; "
                    f"it can be taken over after {IDLE_S:g} s without a command, or by force"
                )
        self._set(run, session)

    def release(self, run: str, session: Session, to: Session | None) -> None:
        """Give control up, to another session or to nobody.

        Raises:
            RunError: the session does not control the run.
        """
        control = self._controls.get(run)
        if control is None or control.holder.session != session.session:
            raise RunError(f"{session} does not control run {run} and cannot release it")
        self._set(run, to)

    def ended(self, session: str) -> None:
        """A connection is over: nobody controls its runs."""
        for run in self._held_by(session):
            self._set(run, None)

    def replaced(self, lost: str, session: Session) -> None:
        """A connection takes the place of one that was lost."""
        for run in self._held_by(lost):
            self._set(run, session)

    def forget(self, run: str) -> None:
        """The run is gone."""
        self._controls.pop(run, None)

    def _held_by(self, session: str) -> list[str]:
        return [run for run, control in self._controls.items() if control.holder.session == session]

    def _set(self, run: str, holder: Session | None) -> None:
        before = self.of(run)
        if holder is None:
            self._controls.pop(run, None)
        else:
            self._controls[run] = _Control(holder, self._clock())
        if self.of(run) != before:
            self._announce(self.of(run))
