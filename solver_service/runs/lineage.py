"""The way of a run through the tree: which run owns a frame index, and which bed held from where."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Leg:
    """The stretch of a lineage that one run computed.

    Attributes:
        run: the run.
        first_index: its first frame; the leg ends where the next one begins.
        revision: revision of the edit list of its bed.
        edits: that list, packed.
        forcing: the changes of its forcing, packed.
    """

    run: str
    first_index: int
    revision: int
    edits: bytes
    forcing: bytes


def lineage(run: str, leg_of: Callable[[str], tuple[Leg, str | None]]) -> tuple[Leg, ...]:
    """The legs from the root of the tree to a run.

    Args:
        run: the last run.
        leg_of: gives the leg of a run and its parent.

    Returns:
        The legs in order of time; first indices never fall.
    """
    legs: list[Leg] = []
    name: str | None = run
    while name is not None:
        leg, name = leg_of(name)
        legs.append(leg)
    return tuple(reversed(legs))


def owner(legs: tuple[Leg, ...], index: int) -> Leg:
    """The leg that owns a frame index: the last one that begins at or before it.

    Args:
        legs: a lineage.
        index: frame index, 0 or more.
    """
    return next(leg for leg in reversed(legs) if leg.first_index <= index)


def branch_point(legs: tuple[Leg, ...], index: int) -> Leg:
    """The leg whose state a branch at `index` takes: the last one that begins before it.

    At the very first frame of a run that is a branch itself this is its parent, so that water which the first
    edit displaced is not displaced a second time, and an edit that was taken back leaves no trace.

    Args:
        legs: a lineage.
        index: frame index, 0 or more.
    """
    return next((leg for leg in reversed(legs) if leg.first_index < index), legs[0])
