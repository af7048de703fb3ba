"""Steering runs: holding, ending, naming and keeping them, and who controls them."""

from __future__ import annotations

from collections.abc import Callable

import protocol
from viewer.app.service_desk import ServiceDesk
from viewer.commands import (
    Command,
    CommandError,
    DeleteRun,
    PauseRun,
    PinRun,
    ReleaseControl,
    RenameRun,
    ResumeRun,
    StopRun,
    TakeControl,
    UnpinRun,
)

__all__ = ["RunSteering"]


class RunSteering:
    """Carries commands about one run to the service.

    Args:
        desk: the dealings with the service.
        shown_run: gives the id of the run on the picture; raises CommandError where there is none.

    Attributes:
        resuming: called before a run is taken up again.
    """

    def __init__(self, desk: ServiceDesk, shown_run: Callable[[], str]) -> None:
        self.resuming: Callable[[], None] = lambda: None
        self._desk = desk
        self._shown_run = shown_run

    def carry_out(self, command: Command) -> bool:
        """Carry out a command about one run; return False when it is none.

        Raises:
            CommandError: there is no such run.
        """
        ask = self._desk.ask
        match command:
            case PauseRun(run):
                name = self._named(run)
                ask(lambda number: protocol.PauseRun(number, run=name), "pause the run")
            case ResumeRun(run):
                self.resuming()
                name = self._named(run)
                ask(lambda number: protocol.ResumeRun(number, run=name), "resume the run")
            case StopRun(run):
                name = self._named(run)
                ask(lambda number: protocol.StopRun(number, run=name), "stop the run")
            case RenameRun(label, run):
                name = self._named(run)
                ask(lambda number: protocol.RenameRun(number, run=name, label=label), "rename the run")
            case PinRun(run):
                name = self._named(run)
                ask(lambda number: protocol.PinRun(number, run=name), "pin the run")
            case UnpinRun(run):
                name = self._named(run)
                ask(lambda number: protocol.UnpinRun(number, run=name), "unpin the run")
            case DeleteRun(run):
                name = self._named(run)
                ask(lambda number: protocol.DeleteRun(number, run=name), "delete the run")
            case TakeControl(run, force):
                name = self._named(run)
                ask(lambda number: protocol.TakeControl(number, run=name, force=force), "take control")
            case ReleaseControl(run, to):
                name = self._named(run)
                ask(lambda number: protocol.ReleaseControl(number, run=name, to=to), "release control")
            case _:
                return False
        return True

    def _named(self, run: str | None) -> str:
        if run is None:
            return self._shown_run()
        if run not in self._desk.book.runs:
            raise CommandError(f"run {run!r} is unknown")
        return run
