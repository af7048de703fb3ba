"""Changes of what drives a flood from outside."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.fields import Command, Identifier, Message, Revision
from protocol.forcing import ForcingChange, ForcingItem
from protocol.limits import MAX_FORCING_CHANGES, MAX_FORCING_ITEMS


class ChangeForcing(Command, frozen=True):
    """Let a list of changes take the place of a run's working forcing.

    The `ack` has result.revision. The water changes by `recalculate` only.

    Attributes:
        run: id of the run.
        changes: how its items differ from the case; an empty list is the case as it is.
    """

    run: Identifier
    changes: Annotated[tuple[ForcingChange, ...], Meta(max_length=MAX_FORCING_CHANGES)]


class ForcingChanged(Message, frozen=True):
    """The working forcing of a run, after each change, for every watcher, and with its subscription.

    Attributes:
        run: id of the run.
        revision: revision of the working forcing; grows by one with every change.
        changes: the working forcing.
        applied: the changes that the run is computed with, from its first frame on.
        items: what the case has, in its order.
    """

    run: Identifier
    revision: Revision
    changes: Annotated[tuple[ForcingChange, ...], Meta(max_length=MAX_FORCING_CHANGES)]
    applied: Annotated[tuple[ForcingChange, ...], Meta(max_length=MAX_FORCING_CHANGES)] = ()
    items: Annotated[tuple[ForcingItem, ...], Meta(max_length=MAX_FORCING_ITEMS)] = ()
