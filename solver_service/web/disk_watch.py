"""Lets the runs of a token wait that has filled its room on the disk: a run grows while it computes."""

from __future__ import annotations

import asyncio
import logging

from solver_service.errors import ServiceError
from solver_service.runs import RunRegistry
from solver_service.runs.run_status import ACTIVE
from solver_service.web.quotas import Quotas

LOG = logging.getLogger(__name__)

INTERVAL_S = 2.0


async def watch_disk(quotas: Quotas, registry: RunRegistry, interval_s: float = INTERVAL_S) -> None:
    """Look at the runs that compute again and again; ends only by being cancelled."""
    while True:
        await asyncio.sleep(interval_s)
        try:
            await halt_over_quota(quotas, registry)
        except ServiceError as error:
            LOG.error("the room that tokens take cannot be looked at: %s", error)


async def halt_over_quota(quotas: Quotas, registry: RunRegistry) -> None:
    """Pause, in words, what computes for an owner that takes more of the disk than it may.

    Raises:
        ServiceError: the rows or the tokens cannot be read.
    """
    for owner in {run.record.owner for run in registry.tree if run.status in ACTIVE}:
        allowed = quotas.limits(owner).max_disk_bytes
        if allowed is None:
            continue
        used = await quotas.disk_bytes(owner)
        if used <= allowed:
            continue
        reason = f"{used} bytes on disk are more than the {allowed} allowed (max_disk_bytes); delete runs"
        for run in registry.tree:
            if run.record.owner == owner and run.status in ACTIVE:
                registry.control.halt(run, reason)
