"""What the holder of a token may do: four scopes, each with the rights of those below, and one table."""

from __future__ import annotations

from enum import IntEnum

from protocol import (
    AppendEdit,
    AppendEdits,
    ChangeForcing,
    Command,
    DeleteEdit,
    DeleteRun,
    GetChannel,
    GetImagery,
    GetSeries,
    GetTerrain,
    ListCases,
    ListRuns,
    PauseRun,
    PinRun,
    PresentView,
    Recalculate,
    RedoEdit,
    ReleaseControl,
    RenameRun,
    ReplaceEdit,
    ResumeRun,
    Seek,
    StartRun,
    StopRun,
    Subscribe,
    TakeControl,
    UndoEdit,
    UnpinRun,
    Unsubscribe,
    operation,
)
from solver_service.errors import AccessError


class Scope(IntEnum):
    """Rights, from few to all: look; steer runs; keep the store; keep the tokens."""

    VIEWER = 1
    CONTROLLER = 2
    OPERATOR = 3
    ADMIN = 4

    def __str__(self) -> str:
        """Its name as people type it."""
        return self.name.lower()


COMMAND_SCOPES: dict[type[Command], Scope] = {
    ListCases: Scope.VIEWER,
    ListRuns: Scope.VIEWER,
    GetTerrain: Scope.VIEWER,
    GetImagery: Scope.VIEWER,
    GetChannel: Scope.VIEWER,
    GetSeries: Scope.VIEWER,
    Subscribe: Scope.VIEWER,
    Unsubscribe: Scope.VIEWER,
    Seek: Scope.VIEWER,
    StartRun: Scope.CONTROLLER,
    PauseRun: Scope.CONTROLLER,
    ResumeRun: Scope.CONTROLLER,
    StopRun: Scope.CONTROLLER,
    RenameRun: Scope.CONTROLLER,
    AppendEdit: Scope.CONTROLLER,
    AppendEdits: Scope.CONTROLLER,
    ReplaceEdit: Scope.CONTROLLER,
    DeleteEdit: Scope.CONTROLLER,
    UndoEdit: Scope.CONTROLLER,
    RedoEdit: Scope.CONTROLLER,
    ChangeForcing: Scope.CONTROLLER,
    Recalculate: Scope.CONTROLLER,
    TakeControl: Scope.CONTROLLER,
    ReleaseControl: Scope.CONTROLLER,
    PresentView: Scope.CONTROLLER,
    PinRun: Scope.OPERATOR,
    UnpinRun: Scope.OPERATOR,
    DeleteRun: Scope.OPERATOR,
}
"""The least scope of each command of the stream."""


def scope_of(name: str) -> Scope:
    """The scope of a name.

    Raises:
        AccessError: there is none of that name.
    """
    for scope in Scope:
        if str(scope) == name:
            return scope
    raise AccessError(f"the scope {name!r} is none of {', '.join(map(str, Scope))}")


def check_scope(command: Command, held: Scope) -> None:
    """Let a command pass.

    Raises:
        AccessError: the token has not the scope that the command needs.
    """
    needed = COMMAND_SCOPES[type(command)]
    if held < needed:
        raise AccessError(f"{operation(command)} needs the scope {needed}; this token has the scope {held}")
