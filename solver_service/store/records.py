"""The rows of the store as values: what is known of a run, a frame, a checkpoint, an edit event."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


@dataclass(frozen=True)
class RunRecord:
    """One run of the tree.

    Attributes:
        run: id, unique for ever.
        case: the name under which the case is offered.
        case_fingerprint: hash of the base bed and forcing; a run is only resumed on the case it began with.
        title: what a person reads.
        parent: the run it branched from, None for a root.
        branch_index: first frame of its own; 0 for a root.
        status: a value of `RunStatus`.
        status_reason: a sentence for failed and paused runs, else empty.
        duration: simulated time at which the run is finished [s].
        output_interval: time between frames [s].
        device: device name as asked for ("auto", "cpu", "cuda:0").
        bed_revision: revision of the edit list that made the bed of this run.
        bed_edits: the packed edit list that made the bed (opaque bytes).
        facts: what the tree keeps of the case: grid, source, licence (opaque bytes).
        label: the name that people gave it, or nothing.
        pinned: whether it is kept whatever the budget of the store.
        owner: id of the token that made it; nothing for the token file.
        forcing: the packed changes of its forcing, from its first frame on (opaque bytes; none by default).
        channels: names of the channels that it keeps, with commas between.
    """

    run: str
    case: str
    case_fingerprint: str
    title: str
    parent: str | None
    branch_index: int
    status: str
    status_reason: str
    duration: float
    output_interval: float
    device: str
    bed_revision: int
    bed_edits: bytes
    facts: bytes
    label: str = ""
    pinned: bool = False
    owner: str = ""
    forcing: bytes = b"\x90"
    channels: str = ""

    @property
    def channel_names(self) -> tuple[str, ...]:
        """The channels that it keeps."""
        return tuple(self.channels.split(",")) if self.channels else ()


@dataclass(frozen=True)
class StoredBytes:
    """Room that a run takes.

    Attributes:
        run: the run.
        owner: id of the token that is charged for it.
        kind: frames, channels or checkpoints.
        size: how much [bytes].
    """

    run: str
    owner: str
    kind: str
    size: int


@dataclass(frozen=True)
class FrameRecord:
    """The commit row of one frame: where its bytes are and how to know that they are whole.

    Attributes:
        run: the run that computed it.
        index: frame number, time = index x output_interval.
        time: simulated time [s].
        revision: edit revision of the bed it was computed on.
        key_index: frame to which it is a delta; equal to index for a key frame.
        segment: name of the segment file in the folder of the run.
        offset: first byte in the segment.
        size: number of bytes.
        crc32: checksum of these bytes.
    """

    run: str
    index: int
    time: float
    revision: int
    key_index: int
    segment: str
    offset: int
    size: int
    crc32: int

    @property
    def is_key(self) -> bool:
        """Whether the frame can be decoded alone."""
        return self.key_index == self.index

    @property
    def name(self) -> str:
        """What it is, in sentences."""
        return f"frame {self.index} of run {self.run}"


@dataclass(frozen=True)
class ChannelRecord:
    """The commit row of a channel of a frame: made with the row of the frame, and gone with it.

    Attributes:
        run: the run that computed it.
        index: frame number.
        channel: name of the channel.
        segment: name of the segment file in the folder of the run.
        offset: first byte in the segment.
        size: number of bytes.
        crc32: checksum of these bytes.
    """

    run: str
    index: int
    channel: str
    segment: str
    offset: int
    size: int
    crc32: int

    @property
    def name(self) -> str:
        """What it is, in sentences."""
        return f"channel {self.channel} of frame {self.index} of run {self.run}"


@dataclass(frozen=True)
class CheckpointRecord:
    """The commit row of one full-precision state.

    Attributes:
        run: the run whose state it is.
        time: simulated time [s].
        step_count: solver steps done.
        name: folder name below the checkpoints of the run.
        crc32: checksum over all arrays and scalars in a fixed order.
        size: bytes on disk.
    """

    run: str
    time: float
    step_count: int
    name: str
    crc32: int
    size: int


class EditEventKind(StrEnum):
    """What happened to the working list of edits."""

    APPEND = "append"
    APPEND_MANY = "append_many"
    REPLACE = "replace"
    DELETE = "delete"
    UNDO = "undo"
    REDO = "redo"


@dataclass(frozen=True)
class EditEvent:
    """One change of the working list of a run, in the order in which it was acknowledged."""

    run: str
    sequence: int
    kind: EditEventKind
    edit: bytes


@dataclass(frozen=True)
class ForcingEvent:
    """One change of the working forcing of a run.

    Attributes:
        run: the run.
        revision: of the working forcing after it; 1 for the first.
        changes: the whole list of changes after it (opaque bytes).
    """

    run: str
    revision: int
    changes: bytes


@dataclass(frozen=True)
class RunEvent:
    """One line of the log of a run: status moves, branches, losses."""

    run: str
    wall_time: float
    kind: str
    detail: str
