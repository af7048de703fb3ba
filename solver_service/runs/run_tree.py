"""Runs as nodes of a tree, as the web process knows them: frames by index, working list of edits, lineage."""

from __future__ import annotations

import asyncio
import math
import secrets
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from protocol import EditLog, LineageEntry, Places, RunInfo
from solver_service.errors import RunError
from solver_service.runs.case_facts import CaseFacts
from solver_service.runs.channels import kept_channels
from solver_service.runs.edit_change import EditChange
from solver_service.runs.forced_course import WorkingForcing
from solver_service.runs.lineage import Leg, branch_point, lineage, owner
from solver_service.runs.run_status import RunStatus, moves_of
from solver_service.runs.worker import Worker
from solver_service.store import EditEvent, FrameRecord, RunRecord

_SLACK = 1e-9


@dataclass
class Run:
    """One run: what is stored of it, and what is known while the service lives.

    Attributes:
        record: the row; status and reason in it are those of the beginning.
        facts: what is kept of its case.
        edit_log: the working list of edits.
        forcing: the working forcing.
        status: where it stands.
        reason: a sentence for failed runs and those that paused by themselves.
        frames: rows of its own frames, from `first_index` without a hole.
        worker: the process that computes or holds it.
        lacks_room: whether it paused because the disk or the budget was full.
        lock: one command at a time.
    """

    record: RunRecord
    facts: CaseFacts
    edit_log: EditLog
    forcing: WorkingForcing
    status: RunStatus
    reason: str
    frames: list[FrameRecord]
    worker: Worker | None = None
    lacks_room: bool = False
    lock: asyncio.Lock = field(default_factory=asyncio.Lock)

    @classmethod
    def of(
        cls, record: RunRecord, events: Iterable[EditEvent] = (), forcing: WorkingForcing | None = None
    ) -> Run:
        """A run as its row and the history of its working lists tell it, without frames."""
        return cls(
            record,
            CaseFacts.unpack(record.facts),
            replayed_log(events),
            forcing or WorkingForcing(),
            RunStatus(record.status),
            record.status_reason,
            [],
        )

    @property
    def run(self) -> str:
        """Its id."""
        return self.record.run

    @property
    def first_index(self) -> int:
        """First frame of its own."""
        return self.record.branch_index

    @property
    def frame_count(self) -> int:
        """Last stored frame index + 1, the shared past included."""
        return self.first_index + len(self.frames)

    @property
    def last_index(self) -> int:
        """Index of its last frame: the first at or after its duration."""
        return math.ceil(self.record.duration / self.record.output_interval - _SLACK)


class RunTree:
    """All runs by id."""

    def __init__(self) -> None:
        self._runs: dict[str, Run] = {}

    def add(self, run: Run) -> None:
        """Take a run in; its parent must be there."""
        self._runs[run.run] = run

    def remove(self, name: str) -> None:
        """Forget a run that has no children."""
        del self._runs[name]

    def children(self, name: str) -> list[Run]:
        """The runs that branched from a run."""
        return [run for run in self._runs.values() if run.record.parent == name]

    def __iter__(self) -> Iterator[Run]:
        """Runs in the order in which they were made."""
        return iter(self._runs.values())

    def __contains__(self, name: str) -> bool:
        return name in self._runs

    def __len__(self) -> int:
        return len(self._runs)

    def get(self, name: str) -> Run:
        """The run of an id.

        Raises:
            RunError: there is none.
        """
        run = self._runs.get(name)
        if run is None:
            raise RunError(f"there is no run {name!r}")
        return run

    def legs(self, name: str) -> tuple[Leg, ...]:
        """The lineage of a run."""
        return lineage(name, self._leg)

    def frame(self, name: str, index: int) -> FrameRecord | None:
        """The row of a frame of a run or of its past; None when it is not stored (yet)."""
        if not index >= 0:
            return None
        holder = self.get(owner(self.legs(name), index).run)
        position = index - holder.first_index
        return holder.frames[position] if position < len(holder.frames) else None

    def branch_parent(self, name: str, index: int) -> Run:
        """The run whose state a branch of `name` at `index` takes."""
        return self.get(branch_point(self.legs(name), index).run)

    def places(self, name: str) -> tuple[Places, ...]:
        """What viewers are told of a run's gauges and sections; nothing where it has none."""
        facts = self.get(name).facts
        has_any = bool(facts.gauges or facts.sections)
        return (Places(name, facts.gauges, facts.sections),) if has_any else ()

    def info(self, run: Run) -> RunInfo:
        """What viewers are told of a run."""
        facts, record = run.facts, run.record
        return RunInfo(
            run=run.run,
            case=record.case,
            title=record.title,
            status=run.status.value,
            grid=facts.grid,
            duration=record.duration,
            output_interval=record.output_interval,
            frame_count=run.frame_count,
            device=record.device,
            hypothetical=facts.hypothetical,
            depth_wet=facts.depth_wet,
            parent=record.parent,
            branch_index=record.branch_index if record.parent else None,
            revision=run.edit_log.revision,
            lineage=tuple(LineageEntry(leg.run, leg.first_index) for leg in self.legs(run.run)),
            start_time=facts.start_time,
            source=facts.source,
            licence=facts.licence,
            message=run.reason,
            label=record.label,
            pinned=record.pinned,
            channels=kept_channels(record.channel_names),
            layers=facts.layers,
            forcing_revision=run.forcing.revision,
            moves=moves_of(run.status, record.pinned),
        )

    def _leg(self, name: str) -> tuple[Leg, str | None]:
        record = self.get(name).record
        leg = Leg(name, record.branch_index, record.bed_revision, record.bed_edits, record.forcing)
        return leg, record.parent


def new_run_id() -> str:
    """An id that no run has had."""
    return f"r{secrets.token_hex(6)}"


def replayed_log(events: Iterable[EditEvent]) -> EditLog:
    """The working list that a history of edit events makes."""
    log = EditLog()
    for event in events:
        EditChange.of(event).make(log)
    return log
