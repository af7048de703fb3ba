"""Changes of forcing along the lineage of a run, as the store keeps them and as models are made of them."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec

from protocol import ForcingChange
from solver_service.runs.lineage import Leg
from solver_service.scenario.forced_model import ForcedFrom
from solver_service.store import ForcingEvent

Changes = tuple[ForcingChange, ...]


def pack_changes(changes: Changes) -> bytes:
    """A list of changes as the store keeps it."""
    return msgspec.msgpack.encode(changes)


def unpack_changes(packed: bytes) -> Changes:
    """A list of changes back."""
    changes: Changes = msgspec.msgpack.decode(packed, type=Changes)
    return changes


@dataclass(frozen=True)
class WorkingForcing:
    """The changes that the next branch of a run is computed with.

    Attributes:
        revision: number of changes of the list.
        changes: the list.
    """

    revision: int = 0
    changes: Changes = ()

    @classmethod
    def of(cls, event: ForcingEvent) -> WorkingForcing:
        """As the store keeps it."""
        return cls(event.revision, unpack_changes(event.changes))

    def event(self, run: str) -> ForcingEvent | None:
        """The row that keeps it for a run; None where nothing was ever changed."""
        return ForcingEvent(run, self.revision, pack_changes(self.changes)) if self.revision else None


def course_of(legs: tuple[Leg, ...], output_interval: float) -> tuple[ForcedFrom, ...]:
    """From when on which changes hold in the run at the end of a lineage.

    Args:
        legs: the lineage.
        output_interval: time between frames [s].
    """
    return tuple(ForcedFrom(leg.first_index * output_interval, unpack_changes(leg.forcing)) for leg in legs)
