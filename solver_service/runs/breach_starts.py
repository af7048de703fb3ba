"""Whether breaches can be moved where a run branches: what the clock has begun cannot be undone."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

from protocol import ForcingItem
from solver_service.errors import RunError
from solver_service.runs.forced_course import Changes
from solver_service.scenario.forced_model import ForcedFrom


class Start(NamedTuple):
    """When a breach begins [s], and whether it then waits until it is overtopped."""

    time: float
    overtopping: bool

    def __str__(self) -> str:
        """For sentences."""
        if math.isinf(self.time):
            return "never"
        return f"{'when overtopped from ' if self.overtopping else ''}{self.time:g} s on"


def start_under(item: ForcingItem, changes: Changes) -> Start:
    """When a breach of a case begins under a list of changes."""
    wanted = next((change.start_time for change in changes if change.id == item.id), None)
    if wanted is None:
        return Start(item.start_time or 0.0, item.overtopping)
    return Start(math.inf if wanted == "never" else wanted, False)


def check_breaches(
    items: tuple[ForcingItem, ...], past: tuple[ForcedFrom, ...], changes: Changes, time: float
) -> None:
    """Refuse to move a breach that has begun at a branch, or to a time before it.

    A breach that waits to be overtopped may have begun too: that only the water tells.

    Args:
        items: what the case has.
        past: the changes along the lineage that is branched.
        changes: those from the branch on.
        time: of the branch [s].

    Raises:
        RunError: naming the breach, when it begins and what is allowed.
    """
    for item in items:
        if item.kind != "breach":
            continue
        begun = _begun(item, past, time)
        held = start_under(item, past[-1].changes)
        wanted = start_under(item, changes)
        if begun is not None:
            if wanted != held:
                raise RunError(
                    f"the breach {item.id!r} has begun at {begun:g} s, before the branch at {time:g} s,"
                    " and cannot be moved; leave it as it is, or branch before"
                )
        elif time > 0.0 and not wanted.overtopping and wanted.time < time:
            raise RunError(
                f"the breach {item.id!r} would begin at {wanted.time:g} s, before the branch at {time:g} s;"
                " a start_time from then on, or never, is allowed"
            )


def _begun(item: ForcingItem, past: tuple[ForcedFrom, ...], time: float) -> float | None:
    """When the clock began a breach, up to a time [s]; None where it has not."""
    if time <= 0.0:
        return None
    for stretch, after in pairwise((*past, ForcedFrom(time, ()))):
        start = start_under(item, stretch.changes)
        if not start.overtopping and start.time <= after.time and after.time > 0.0:
            return start.time
    return None
