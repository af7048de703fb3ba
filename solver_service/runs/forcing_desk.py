"""Changes of the working forcing of runs: each is stored before it counts."""

from __future__ import annotations

from protocol import ForcingChanged, check_forcing
from solver_service.runs.audience import Audience
from solver_service.runs.forced_course import Changes, WorkingForcing, pack_changes, unpack_changes
from solver_service.runs.run_status import Move, check_move
from solver_service.runs.run_tree import RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.store import ForcingEvent, RunDatabase


class ForcingDesk:
    """The working forcing of all runs."""

    def __init__(self, tree: RunTree, store: StoreThread, audience: Audience) -> None:
        """Work on the runs of a tree."""
        self._tree = tree
        self._store = store
        self._audience = audience

    def changed(self, name: str) -> ForcingChanged:
        """The working forcing of a run as it is told to viewers."""
        run = self._tree.get(name)
        return ForcingChanged(
            name,
            run.forcing.revision,
            run.forcing.changes,
            unpack_changes(run.record.forcing),
            run.facts.forcing,
        )

    async def change(self, name: str, changes: Changes) -> int:
        """Let a list take the place of a run's working forcing; gives the new revision.

        Raises:
            ForcingError: a change does not fit the case.
            StoreError: it cannot be stored; nothing has changed.
        """
        run = self._tree.get(name)
        check_forcing(changes, run.facts.forcing)
        async with run.lock:
            check_move(run.run, run.status, Move.FORCE)
            event = ForcingEvent(run.run, run.forcing.revision + 1, pack_changes(changes))
            await self._store.call(RunDatabase.append_forcing_event, event)
            run.forcing = WorkingForcing.of(event)
        self._audience.announce(self.changed(name))
        return event.revision
