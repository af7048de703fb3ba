"""The event log of a run: everything from which its frames can be computed again, and how to do it.

A log is a text of JSON lines: first the run and its lineage (case, fingerprint of bed and forcing, branch
points, the edits under each bed, the changes of its forcing), then every change of its working lists, every
move of the run, and the checksum of every frame. The same case and the same log give the same bytes.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import msgspec

from protocol import BlockLayout, Edit, FrameEncoder
from solver_service.errors import StoreError
from solver_service.runs.computation import Computation
from solver_service.runs.edit_blobs import pack_edits, unpack_edits
from solver_service.runs.edit_change import EditChange
from solver_service.runs.forced_course import Changes, course_of, pack_changes, unpack_changes
from solver_service.runs.frame_grouping import FrameGrouping
from solver_service.runs.lineage import Leg, lineage
from solver_service.store import RunDatabase


class LoggedLeg(msgspec.Struct, frozen=True):
    """A run of the lineage: its first frame, and the bed and the forcing that held from there on."""

    run: str
    first_index: int
    revision: int
    edits: tuple[Edit, ...]
    forcing: Changes = ()

    def leg(self) -> Leg:
        """As runs know it."""
        return Leg(
            self.run, self.first_index, self.revision, pack_edits(self.edits), pack_changes(self.forcing)
        )


class LoggedRun(msgspec.Struct, frozen=True, tag="run"):
    """What was computed: times in seconds."""

    run: str
    case: str
    case_fingerprint: str
    device: str
    duration: float
    output_interval: float
    legs: tuple[LoggedLeg, ...]


class LoggedEdit(msgspec.Struct, frozen=True, tag="edit"):
    """A change of the working list, in the order in which it was acknowledged.

    Attributes:
        sequence: 1 for the first.
        kind: what happened.
        edit: the edit that was added, or that came in the place of the one of its id.
        edits: the edits that were added at once.
        deleted: id of the edit that was deleted.
    """

    sequence: int
    kind: str
    edit: Edit | None
    edits: tuple[Edit, ...] = ()
    deleted: str = ""


class LoggedForcing(msgspec.Struct, frozen=True, tag="forcing"):
    """A change of the working forcing: its revision, and the whole list of changes to the case after it."""

    revision: int
    changes: Changes


class LoggedMove(msgspec.Struct, frozen=True, tag="move"):
    """Something that happened to the run, at a wall clock time in seconds since 1970."""

    wall_time: float
    kind: str
    detail: str


class LoggedFrame(msgspec.Struct, frozen=True, tag="frame"):
    """A frame of the run's own, by the checksum of its bytes."""

    index: int
    size: int
    crc32: int


LoggedEvent = LoggedEdit | LoggedForcing | LoggedMove
Line = LoggedRun | LoggedEvent | LoggedFrame
_DECODER = msgspec.json.Decoder(Line)


@dataclass(frozen=True)
class EventLog:
    """A log in memory.

    Attributes:
        run: what was computed.
        events: changes of edits and of forcing, and moves.
        frames: its own frames by index.
    """

    run: LoggedRun
    events: tuple[LoggedEvent, ...]
    frames: tuple[LoggedFrame, ...]

    def lines(self) -> bytes:
        """The log as text, one JSON object a line."""
        everything: list[Line] = [self.run, *self.events, *self.frames]
        return b"".join(msgspec.json.encode(line) + b"\n" for line in everything)


def read_event_log(database: RunDatabase, name: str) -> EventLog:
    """The log of a stored run.

    Raises:
        StoreError: there is no such run.
    """
    runs = {record.run: record for record in database.runs()}
    if name not in runs:
        raise StoreError(f"there is no run {name!r}; there are {', '.join(sorted(runs)) or 'none'}")
    record = runs[name]

    def leg_of(run: str) -> tuple[Leg, str | None]:
        found = runs[run]
        leg = Leg(run, found.branch_index, found.bed_revision, found.bed_edits, found.forcing)
        return leg, found.parent

    legs = tuple(
        LoggedLeg(
            leg.run, leg.first_index, leg.revision, unpack_edits(leg.edits), unpack_changes(leg.forcing)
        )
        for leg in lineage(name, leg_of)
    )
    run = LoggedRun(
        name,
        record.case,
        record.case_fingerprint,
        record.device,
        record.duration,
        record.output_interval,
        legs,
    )
    edits = tuple(_logged(event.sequence, EditChange.of(event)) for event in database.edit_events(name))
    forced = database.forcing_events(name)
    forcing = tuple(LoggedForcing(event.revision, unpack_changes(event.changes)) for event in forced)
    moves = tuple(
        LoggedMove(event.wall_time, event.kind, event.detail) for event in database.run_events(name)
    )
    frames = tuple(LoggedFrame(row.index, row.size, row.crc32) for row in database.frames(name))
    return EventLog(run, (*edits, *forcing, *moves), frames)


def _logged(sequence: int, change: EditChange) -> LoggedEdit:
    edits = change.edits
    if len(edits) == 1:
        return LoggedEdit(sequence, change.kind.value, edits[0])
    return LoggedEdit(sequence, change.kind.value, None, edits, change.deleted)


def parse_event_log(text: bytes) -> EventLog:
    """A log from its text.

    Raises:
        StoreError: a line is not one of a log, or the first is not the run.
    """
    try:
        lines = [_DECODER.decode(line) for line in text.splitlines()]
    except msgspec.MsgspecError as error:
        raise StoreError(f"this is no event log of a run: {error}") from error
    if not lines or not isinstance(lines[0], LoggedRun):
        raise StoreError("this is no event log of a run: its first line must be of type 'run'")
    events = tuple(line for line in lines if isinstance(line, LoggedEvent))
    return EventLog(lines[0], events, tuple(line for line in lines if isinstance(line, LoggedFrame)))


def replay(
    log: EventLog, case: str | None = None, threads: int | None = None
) -> Iterator[tuple[LoggedFrame, bytes]]:
    """Compute the frames of a log again, from time 0.

    Args:
        log: the log.
        case: name or path of the case; None for the name in the log.
        threads: solver threads on the CPU; None for all cores.

    Yields:
        Each frame of the log with the bytes that were computed now.

    Raises:
        ServiceError: the case cannot be loaded, or is not the one of the log.
    """
    run = log.run
    computation = Computation(case or run.case, run.device, threads)
    if computation.fingerprint != run.case_fingerprint:
        raise StoreError(f"case {computation.name} is not the one that run {run.run} was computed from")
    layout = BlockLayout(computation.case.grid.nrows, computation.case.grid.ncols)
    encoder, grouping = FrameEncoder(layout), FrameGrouping()
    logged = {frame.index: frame for frame in log.frames}
    legs, interval = tuple(leg.leg() for leg in run.legs), run.output_interval
    computation.restore(None, course_of(legs[:1], interval))
    position = 0
    for index in range(max(logged, default=-1) + 1):
        computation.advance_to(index * interval, lambda: False)
        while position + 1 < len(run.legs) and run.legs[position + 1].first_index == index:
            position += 1
            computation.enter(legs[position], course_of(legs[: position + 1], interval))
        if position + 1 == len(run.legs) and index in logged:
            q, states, scale = grouping.quantise(index, computation.quantise, computation.depth_max)
            time, revision = computation.solver.time, run.legs[-1].revision
            bed = computation.solver.breached_bed()
            yield (
                logged[index],
                encoder.encode(run.run, index, time, revision, (q, states), scale=scale, bed=bed),
            )


def is_same(frame: LoggedFrame, packed: bytes) -> bool:
    """Whether these are the bytes of the log."""
    return (len(packed), zlib.crc32(packed)) == (frame.size, frame.crc32)
