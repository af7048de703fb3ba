"""The life of a run: start, pause, resume, stop, rename, pin, delete."""

from __future__ import annotations

import asyncio
from dataclasses import replace

from protocol import ChannelName, RunChanged, RunRemoved, check_forcing
from solver_service.errors import RunError
from solver_service.runs.audience import Audience
from solver_service.runs.case_catalogue import CaseCatalogue
from solver_service.runs.controllers import Controllers
from solver_service.runs.edit_blobs import pack_edits
from solver_service.runs.forced_course import Changes, WorkingForcing, pack_changes
from solver_service.runs.run_reports import RunReports
from solver_service.runs.run_status import Move, RunStatus, check_move
from solver_service.runs.run_tree import Run, RunTree, new_run_id
from solver_service.runs.store_thread import StoreThread
from solver_service.runs.supervisor import Supervisor
from solver_service.runs.worker_messages import Pause
from solver_service.store import DataFolder, RunDatabase, RunRecord, remove_run_files


class RunControl:
    """Moves runs from status to status by command; what is acknowledged is stored."""

    def __init__(
        self,
        tree: RunTree,
        store: StoreThread,
        folder: DataFolder,
        catalogue: CaseCatalogue,
        controllers: Controllers,
        supervisor: Supervisor,
        reports: RunReports,
        audience: Audience,
        device: str,
        channels: tuple[ChannelName, ...],
    ) -> None:
        """Control the runs of a tree.

        `device` is that of runs that ask for "auto", `channels` what runs may keep beside the depth.
        """
        self._tree = tree
        self._store = store
        self._folder = folder
        self._catalogue = catalogue
        self._controllers = controllers
        self._supervisor = supervisor
        self._reports = reports
        self._audience = audience
        self._device = device
        self._channels = channels

    async def start(
        self,
        case: str,
        duration: float | None = None,
        output_interval: float | None = None,
        device: str = "auto",
        paused: bool = False,
        owner: str = "",
        forcing: Changes = (),
        channels: tuple[ChannelName, ...] | None = None,
    ) -> Run:
        """Start a run of a case from time 0.

        Args:
            case: name of the case.
            duration: simulated time [s]; None for the case's own.
            output_interval: time between frames [s]; None for the case's own.
            device: where to compute.
            paused: stop after the first frame.
            owner: id of the token that is charged for it.
            forcing: how its forcing differs from the case.
            channels: what to keep beside the depth; None for all that runs may keep.

        Raises:
            ForcingError: a change of forcing does not fit the case.
            RunError: the case is not offered, cannot be loaded, or no worker is free.
            StoreError: the run cannot be stored.
        """
        case = self._catalogue.name(case)
        with self._catalogue.held(case) as source:
            device = self._device if device == "auto" else device
            name = new_run_id()
            worker = await self._supervisor.pool.take(name, source, device)
            try:
                loaded = await worker.load(source, device)
                check_forcing(forcing, loaded.facts.forcing)
                working = WorkingForcing(1 if forcing else 0, forcing)
                record = RunRecord(
                    run=name,
                    case=case,
                    case_fingerprint=loaded.fingerprint,
                    title=loaded.title,
                    parent=None,
                    branch_index=0,
                    status=RunStatus.STARTING.value,
                    status_reason="",
                    duration=duration or loaded.duration,
                    output_interval=output_interval or loaded.output_interval,
                    device=loaded.device,
                    bed_revision=0,
                    bed_edits=pack_edits(()),
                    facts=loaded.facts.pack(),
                    owner=owner,
                    forcing=pack_changes(forcing),
                    channels=",".join(
                        name for name in self._channels if channels is None or name in channels
                    ),
                )
                await self._store.call(RunDatabase.insert_run, record, (), working.event(name))
            except BaseException:
                self._supervisor.pool.release(worker)
                raise
            run = Run.of(record, (), working)
            self._tree.add(run)
            self._supervisor.begin(run, worker, paused=paused)
            self._audience.announce(RunChanged(self._tree.info(run)))
            return run

    async def pause(self, name: str) -> None:
        """Stop computing a run until `resume`."""
        run = self._tree.get(name)
        async with run.lock:
            self._reports.move(run, Move.PAUSE)
            if run.worker is not None and run.worker.run == name:
                run.worker.send(Pause(name))

    def halt(self, run: Run, reason: str) -> None:
        """Let a run that computes wait, and tell people why."""
        self._reports.move(run, Move.WAIT, reason)
        self._reports.notice("error", f"paused: {reason}", run.run)
        if run.worker is not None and run.worker.run == run.run:
            run.worker.send(Pause(run.run))

    async def resume(self, name: str) -> None:
        """Go on with a paused or failed run, from where it stood or from its last checkpoint."""
        run = self._tree.get(name)
        async with run.lock:
            check_move(name, run.status, Move.RESUME)
            worker = await self._supervisor.worker_for(run)
            self._supervisor.policy.forget(name)
            try:
                self._reports.move(run, Move.RESUME)
            except RunError:
                self._supervisor.pool.release(worker)
                if run.status is not RunStatus.FINISHED:
                    raise
                return  # its rows have told meanwhile that nothing is left to compute
            self._supervisor.begin(run, worker)

    async def stop(self, name: str) -> None:
        """End a run for good; its frames stay."""
        run = self._tree.get(name)
        async with run.lock:
            self._reports.move(run, Move.STOP)
            self._free_worker(run)

    async def rename(self, name: str, label: str) -> None:
        """Give a run a name for people; an empty one takes it away."""
        await self._mark(name, Move.RENAME, label=label)

    async def pin(self, name: str, pinned: bool = True) -> None:
        """Keep a run whatever the budget of the store, or no longer."""
        await self._mark(name, Move.PIN if pinned else Move.UNPIN, pinned=pinned)

    async def delete(self, name: str) -> None:
        """Forget a run and free its room.

        Raises:
            RunError: it computes, is pinned, or other runs branched from it.
        """
        run = self._tree.get(name)
        async with run.lock:
            check_move(name, run.status, Move.DELETE)
            if run.record.pinned:
                raise RunError(f"run {name} is pinned and cannot be deleted; unpin it first")
            children = [child.run for child in self._tree.children(name)]
            if children:
                raise RunError(
                    f"run {name} holds the past of {', '.join(children)} and cannot be deleted; "
                    "delete them first"
                )
            self._free_worker(run)
            await self._supervisor.settle(run)
            await self._store.call(RunDatabase.delete_run, name)
            self._tree.remove(name)
            self._audience.announce(RunRemoved(name))  # at once: nobody may ask the tree for it any more
            self._supervisor.policy.forget(name)
            self._controllers.forget(name)
            await asyncio.to_thread(remove_run_files, self._folder, name)

    async def _mark(self, name: str, move: Move, **fields: str | bool) -> None:
        run = self._tree.get(name)
        async with run.lock:
            check_move(name, run.status, move)
            record = replace(run.record, **fields)  # type: ignore[arg-type]
            await self._store.call(RunDatabase.mark_run, name, record.label, record.pinned)
            run.record = record
        self._audience.announce(RunChanged(self._tree.info(run)))

    def _free_worker(self, run: Run) -> None:
        if run.worker is not None and run.worker.run == run.run:
            run.worker.send(Pause(run.run, final=True))
            self._supervisor.pool.release(run.worker)
        run.worker = None
