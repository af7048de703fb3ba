"""REST of an operator: what may be done to any run or connection, whoever controls it."""

from __future__ import annotations

from collections.abc import Callable, Set
from typing import Annotated, Any, Literal

from fastapi import APIRouter, HTTPException, Path

from solver_service.runs import RunRegistry
from solver_service.web.api_answers import answers
from solver_service.web.quotas import Quotas
from solver_service.web.scopes import Scope
from solver_service.web.stream import POLICY_VIOLATION, StreamConnection

RUN_ID = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", examples=["r0123456789ab"])]
SESSION_ID = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", examples=["s0123456789ab"])]
Action = Literal["pause", "resume", "stop", "pin", "unpin"]
ACTION = Annotated[Action, Path(examples=["pause"])]


def action_router(
    registry: RunRegistry,
    quotas: Quotas,
    connections: Set[StreamConnection],
    needs: Callable[[Scope], Any],
) -> APIRouter:
    """The routes of an operator's actions.

    Args:
        registry: the runs.
        quotas: how much the owner of a run may take.
        connections: the open streams.
        needs: makes the dependency that lets a scope pass.
    """
    router = APIRouter(tags=["operator"], dependencies=[needs(Scope.OPERATOR)])

    @router.post(
        "/v1/runs/{run}/{action}",
        status_code=204,
        responses=answers(None, None, 409, 429, 507, status=204),
    )
    async def act(run: RUN_ID, action: ACTION) -> None:
        """Pause, resume, stop, pin or unpin a run, whoever controls it."""
        await registry.carry_through(_carried_out(registry, quotas, run, action))

    @router.delete("/v1/runs/{run}", status_code=204, responses=answers(None, None, 409, 507, status=204))
    async def delete_run(run: RUN_ID) -> None:
        """Delete a run; refused while it computes, is pinned, or others branched from it."""
        await registry.carry_through(registry.control.delete(run))

    @router.delete(
        "/v1/connections/{session}", status_code=204, responses=answers(None, None, 404, status=204)
    )
    async def end_connection(session: SESSION_ID) -> None:
        """End a connection; the viewer is told why and does not come back by itself."""
        for connection in tuple(connections):
            if connection.name == session:
                connection.end(POLICY_VIOLATION, "an operator has ended this connection")
                return
        raise HTTPException(404, f"there is no connection {session!r}")

    return router


async def _carried_out(registry: RunRegistry, quotas: Quotas, run: str, action: Action) -> None:
    control = registry.control
    match action:
        case "pause":
            await control.pause(run)
        case "resume":
            async with quotas.resume(registry.tree.get(run)):
                await control.resume(run)
        case "stop":
            await control.stop(run)
        case "pin" | "unpin":
            await control.pin(run, action == "pin")
