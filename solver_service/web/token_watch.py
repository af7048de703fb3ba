"""Ends the connections whose token was revoked or has expired."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Set
from typing import Protocol

from solver_service.errors import StoreError
from solver_service.web.auth import Access, Gate

LOG = logging.getLogger(__name__)

INTERVAL_S = 1.0


class Guarded(Protocol):
    """A connection as the watch sees it."""

    @property
    def access(self) -> Access | None:
        """What it may do; None before it has shown a token."""

    def withdraw(self) -> None:
        """Tell it that its token no longer holds, and close."""


async def watch_tokens(gate: Gate, connections: Set[Guarded], interval_s: float = INTERVAL_S) -> None:
    """Look at the tokens of all connections again and again; ends only by being cancelled."""
    while True:
        await asyncio.sleep(interval_s)
        try:
            for connection in tuple(connections):
                if connection.access is not None and not gate.still_holds(connection.access):
                    connection.withdraw()
        except StoreError as error:
            LOG.error("tokens cannot be looked at: %s", error)
