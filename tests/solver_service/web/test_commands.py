"""What a command asks of the connection before it costs anything; see test_stream for the rest."""

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest

from protocol import GetChannel, GetSeries, GetTerrain
from solver_service.errors import RunError
from solver_service.web.commands import LARGE_ANSWERS, carry_out
from solver_service.web.outbox import Outbox


@pytest.mark.parametrize(
    "command", [GetTerrain(1, "r"), GetChannel(1, "r", 0, "maxima"), GetSeries(1, "r")], ids=repr
)
def test_who_leaves_large_answers_unread_gets_no_more_until_they_are_taken(command: Any) -> None:
    asked: list[str] = []

    class Runs:
        def __getattr__(self, name: str) -> Any:
            asked.append(name)
            raise LookupError(name)

    client: Any = SimpleNamespace(registry=Runs(), outbox=Outbox())
    for _ in range(LARGE_ANSWERS):
        client.outbox.put_bulk([b"part"])
    with pytest.raises(RunError, match=f"{LARGE_ANSWERS} large answers are on their way"):
        asyncio.run(carry_out(command, client, None))  # type: ignore[arg-type]
    assert asked == [], "nothing was read for it"
    client.outbox.next()
    client.outbox.next()
    with pytest.raises(LookupError):
        asyncio.run(carry_out(command, client, None))  # type: ignore[arg-type]
