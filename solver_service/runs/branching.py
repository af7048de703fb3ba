"""Recalculate: a run branches at a frame, and its child goes on with the working list as terrain."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from dataclasses import replace

from protocol import RunBranched, RunChanged
from solver_service.errors import RunError
from solver_service.runs.audience import Audience
from solver_service.runs.breach_starts import check_breaches
from solver_service.runs.case_catalogue import CaseCatalogue
from solver_service.runs.edit_blobs import pack_edits
from solver_service.runs.forced_course import WorkingForcing, course_of, pack_changes
from solver_service.runs.run_reports import RunReports
from solver_service.runs.run_status import ACTIVE, Move, RunStatus, check_move
from solver_service.runs.run_tree import Run, RunTree, new_run_id
from solver_service.runs.store_thread import StoreThread
from solver_service.runs.supervisor import Supervisor
from solver_service.runs.worker import Worker
from solver_service.store import RunDatabase, RunRecord

SAVE_TIMEOUT_S = 10.0


class Branching:
    """Makes the children of runs."""

    def __init__(
        self,
        tree: RunTree,
        store: StoreThread,
        catalogue: CaseCatalogue,
        supervisor: Supervisor,
        reports: RunReports,
        audience: Audience,
    ) -> None:
        """Branch the runs of a tree."""
        self._tree = tree
        self._store = store
        self._catalogue = catalogue
        self._supervisor = supervisor
        self._reports = reports
        self._audience = audience

    async def recalculate(
        self,
        name: str,
        index: int,
        revision: int,
        keep_parent: bool = False,
        owner: str = "",
        forcing_revision: int | None = None,
    ) -> Run:
        """Branch a run at a frame with its working list as terrain and its working forcing.

        Args:
            name: the run on the screen.
            index: frame at or before the playback time.
            revision: revision of the working list that is meant.
            keep_parent: whether the run goes on computing beside its child.
            owner: id of the token that is charged for the child.
            forcing_revision: revision of the working forcing that is meant; None for the newest.

        Returns:
            The child.

        Raises:
            RunError: the frame is not computed yet, a working list has moved on, or a breach that has begun
                would be moved.
            StoreError: the child cannot be stored.
        """
        run = self._tree.get(name)
        async with run.lock:
            check_move(name, run.status, Move.RECALCULATE)
            parent = self._tree.branch_parent(name, index)
            if self._tree.frame(parent.run, index) is None:
                raise RunError(
                    f"frame {index} of run {name} is not computed yet; "
                    f"0 to {run.frame_count - 1} can be branched"
                )
            if revision != run.edit_log.revision:
                raise RunError(
                    f"the edits of run {name} are at revision {run.edit_log.revision}, not {revision}; "
                    "look at them again"
                )
            forcing = self._forcing_for(run, parent, index, forcing_revision)
            record = replace(
                parent.record,
                run=new_run_id(),
                parent=parent.run,
                branch_index=index,
                status=RunStatus.STARTING.value,
                status_reason="",
                label="",
                pinned=False,
                owner=owner,
                bed_revision=revision,
                bed_edits=pack_edits(run.edit_log.edits),
                forcing=pack_changes(forcing.changes),
            )
            worker = await self._worker_for_child(run, parent, record, keep_parent)
            try:
                events = await self._store.call(RunDatabase.copied_edit_events, name, record.run)
                await self._store.call(RunDatabase.insert_run, record, events, forcing.event(record.run))
            except BaseException:
                self._supervisor.pool.release(worker)
                raise
            child = Run.of(record, events, forcing)
            self._tree.add(child)
            self._supervisor.begin(child, worker)
            if not keep_parent and run.status in ACTIVE:
                self._reports.move(run, Move.PAUSE)
        info = self._tree.info(child)
        self._audience.announce(RunChanged(info))
        self._audience.announce(RunBranched(parent.run, info))
        return child

    def _forcing_for(self, run: Run, parent: Run, index: int, revision: int | None) -> WorkingForcing:
        """The working forcing of a run, for a child of `parent`.

        Raises:
            RunError: it has moved on, or a breach cannot be moved.
        """
        forcing = run.forcing
        if revision is not None and revision != forcing.revision:
            raise RunError(
                f"the forcing of run {run.run} is at revision {forcing.revision}, not {revision}; "
                "look at it again"
            )
        interval = parent.record.output_interval
        past = course_of(self._tree.legs(parent.run), interval)
        check_breaches(run.facts.forcing, past, forcing.changes, index * interval)
        return forcing

    async def _worker_for_child(self, run: Run, parent: Run, child: RunRecord, keep_parent: bool) -> Worker:
        """The run's own warm worker, or with `keep_parent` another one that finds the state on disk."""
        worker = run.worker
        held = worker is not None and not worker.is_dead and worker.run == run.run
        if worker is not None and held and not keep_parent:
            run.worker = None
            worker.run = child.run
            return worker
        if worker is not None and held:
            with suppress(TimeoutError):  # then the other one goes on from an earlier state, to the same bits
                await asyncio.wait_for(worker.save_state(parent.run, child.branch_index), SAVE_TIMEOUT_S)
        return await self._supervisor.pool.take(child.run, self._catalogue.source(child.case), child.device)
