import typing

import pytest

import protocol
from protocol import Command
from solver_service.errors import AccessError
from solver_service.web.scopes import COMMAND_SCOPES, Scope, check_scope, scope_of

COMMANDS = {kind for kind in typing.get_args(protocol.ClientMessage) if issubclass(kind, Command)}


def test_every_command_of_the_protocol_has_a_scope_and_nothing_else_has() -> None:
    assert len(COMMANDS) >= 20
    assert set(COMMAND_SCOPES) == COMMANDS


def test_a_viewer_can_change_nothing_and_only_an_operator_can_forget_a_run() -> None:
    looks = {kind.__name__ for kind, scope in COMMAND_SCOPES.items() if scope == Scope.VIEWER}
    asks = {"ListCases", "ListRuns", "GetTerrain", "GetChannel", "GetSeries", "GetImagery"}
    assert looks == asks | {"Subscribe", "Unsubscribe", "Seek"}
    keeps = {kind.__name__ for kind, scope in COMMAND_SCOPES.items() if scope == Scope.OPERATOR}
    assert keeps == {"PinRun", "UnpinRun", "DeleteRun"}


@pytest.mark.parametrize("held", Scope)
@pytest.mark.parametrize(
    ("command", "needed"),
    [
        (protocol.ListRuns(1), Scope.VIEWER),
        (protocol.PauseRun(1, "r1"), Scope.CONTROLLER),
        (protocol.DeleteRun(1, "r1"), Scope.OPERATOR),
    ],
)
def test_a_command_passes_with_its_scope_or_a_higher_one(
    command: Command, needed: Scope, held: Scope
) -> None:
    if held >= needed:
        check_scope(command, held)
    else:
        with pytest.raises(AccessError, match=f"needs the scope {needed}; this token has the scope {held}"):
            check_scope(command, held)


def test_a_scope_is_found_by_its_name_alone() -> None:
    assert [scope_of(str(scope)) for scope in Scope] == list(Scope)
    for name in ("root", "ADMIN", ""):
        with pytest.raises(AccessError, match="viewer, controller, operator, admin"):
            scope_of(name)
