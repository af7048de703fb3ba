"""Runs: starting, pausing, stopping, branching, and what the service says about them."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, get_args

from msgspec import Meta

from protocol.fields import (
    Command,
    CommandId,
    Coordinate,
    Elevation,
    FrameIndex,
    Identifier,
    Message,
    Name,
    NotNegative,
    Positive,
    Revision,
    Side,
    Text,
    WireStruct,
)
from protocol.forcing import ForcingChange
from protocol.grid import GridGeometry
from protocol.limits import MAX_CELLS, MAX_FORCING_CHANGES
from protocol.messages.channels import ChannelName
from protocol.messages.imagery import Layers

Forcing = Annotated[tuple[ForcingChange, ...], Meta(max_length=MAX_FORCING_CHANGES)]
RunStatus = Literal["starting", "running", "paused", "finished", "stopped", "failed"]
Channels = Annotated[tuple[ChannelName, ...], Meta(max_length=len(get_args(ChannelName)))]


class ListRuns(Command, frozen=True):
    """Ask for the runs the service holds; `run_list` is the answer."""


class StartRun(Command, frozen=True):
    """Start a run of a case; the `ack` has result.run, the new id, and `run_changed` follows.

    Attributes:
        case: name of the case.
        duration: simulated time [s], or none for the case's own.
        output_interval: time between frames [s], or none for the case's own.
        device: "auto", "cpu" or "cuda:N".
        paused: whether to stop after the frame at time 0.
        forcing: how its forcing differs from the case, from time 0 on.
        channels: what to keep beside the depth; none for what the service keeps by itself.
    """

    left_out: ClassVar[tuple[str, ...]] = ("forcing", "channels")

    case: Name
    duration: Positive | None = None
    output_interval: Positive | None = None
    device: Annotated[str, Meta(pattern=r"^(auto|cpu|cuda(:[0-9]{1,3})?)\Z")] = "auto"
    paused: bool = False
    forcing: Forcing = ()
    channels: Channels | None = None


class PauseRun(Command, frozen=True):
    """Stop computing a run until `resume_run`.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class ResumeRun(Command, frozen=True):
    """Go on computing a paused run.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class StopRun(Command, frozen=True):
    """End a run for good; its frames stay.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class RenameRun(Command, frozen=True):
    """Give a run a name for people.

    Attributes:
        run: id of the run.
        label: the name; an empty one takes it away.
    """

    run: Identifier
    label: Name


class PinRun(Command, frozen=True):
    """Keep a run whatever the budget of the store.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class UnpinRun(Command, frozen=True):
    """Let a run go again when the store needs room.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class DeleteRun(Command, frozen=True):
    """Forget a run and its frames; refused while it computes, is pinned, or others branched from it.

    Attributes:
        run: id of the run.
    """

    run: Identifier


class Recalculate(Command, frozen=True):
    """Branch a run at a frame with the working list of edits as its terrain and its working forcing.

    The `ack` has result.run, the child's id; `run_changed` of the child follows, and the requester's
    subscription goes on with the child from the branch index. Other clients get `run_branched` and stay.

    Attributes:
        run: id of the parent.
        index: frame index to branch at: the last frame at or before the playback time.
        revision: revision of the working list that is meant; refused when the list has moved on.
        keep_parent: whether the parent goes on computing (else it pauses).
        forcing_revision: revision of the working forcing that is meant; refused when it has moved on, nil for
            the newest.
    """

    left_out: ClassVar[tuple[str, ...]] = ("forcing_revision",)

    run: Identifier
    index: FrameIndex
    revision: Revision
    keep_parent: bool = False
    forcing_revision: Revision | None = None


class GridInfo(WireStruct, frozen=True):
    """A `GridGeometry` on the wire.

    Attributes:
        nrows: rows, from south to north.
        ncols: columns, from west to east.
        dx: cell size [m].
        x0: x of the south-western corner [m].
        y0: y of the south-western corner [m].
        crs: projected coordinate system, or "local".
        vertical_datum: what elevation 0 means.
        datum_offset: elevation [m] to add to every elevation on the wire, but not to `level` of an edit.
    """

    nrows: Side
    ncols: Side
    dx: Positive
    x0: Coordinate
    y0: Coordinate
    crs: Name = "local"
    vertical_datum: Name = ""
    datum_offset: Elevation = 0.0

    def __post_init__(self) -> None:
        """Refuse more cells than a grid may have."""
        super().__post_init__()
        if self.nrows * self.ncols > MAX_CELLS:
            raise ValueError(f"A grid of {self.nrows} x {self.ncols} cells passes the limit of {MAX_CELLS}")

    @classmethod
    def from_geometry(cls, grid: GridGeometry) -> GridInfo:
        """The wire form of a geometry."""
        return cls(
            grid.nrows,
            grid.ncols,
            grid.dx,
            grid.x0,
            grid.y0,
            grid.crs,
            grid.vertical_datum,
            grid.datum_offset,
        )

    @property
    def geometry(self) -> GridGeometry:
        """The geometry itself."""
        return GridGeometry(
            self.nrows,
            self.ncols,
            self.dx,
            self.x0,
            self.y0,
            self.crs,
            self.vertical_datum,
            self.datum_offset,
        )


class LineageEntry(WireStruct, frozen=True):
    """A run whose frames belong to this run's past.

    Attributes:
        run: id of the run that holds the frames.
        first_index: first frame index it holds; it ends where the next entry begins.
    """

    run: Identifier
    first_index: FrameIndex


class RunInfo(WireStruct, frozen=True):
    """Everything about a run but its frames.

    Attributes:
        run: id of the run.
        case: name of its case.
        title: title of its case.
        status: what it does now.
        grid: its grid.
        duration: simulated time at its end [s].
        output_interval: time between frames [s]; frame k is at k x output_interval.
        frame_count: last stored frame index + 1.
        device: where it is computed.
        hypothetical: whether the event never happened; shown on every picture.
        depth_wet: depth below which a cell is sent as dry [m].
        parent: id of the run it branched from.
        branch_index: frame index where it branched; its own frames begin there.
        revision: revision of its working list of edits.
        lineage: where the frames of its past are, oldest first, itself last.
        start_time: clock time of frame 0, ISO 8601 with offset.
        source: where the data comes from.
        licence: licence of the data.
        message: why it failed or stopped.
        label: the name that people gave it.
        pinned: whether it is kept whatever the budget of the store.
        forcing_revision: revision of its working forcing.
        moves: what its status allows now, of "pause", "resume", "stop", "delete", "pin", "unpin".
        channels: what it keeps beside the depth, for `get_channel`.
        layers: pictures of its terrain, for `get_imagery`.
    """

    left_out: ClassVar[tuple[str, ...]] = ("forcing_revision", "channels", "layers", "moves")

    run: Identifier
    case: Name
    title: Name
    status: RunStatus
    grid: GridInfo
    duration: Positive
    output_interval: Positive
    frame_count: FrameIndex
    device: Name
    hypothetical: bool
    depth_wet: NotNegative
    parent: Identifier | None = None
    branch_index: FrameIndex | None = None
    revision: Revision = 0
    lineage: Annotated[tuple[LineageEntry, ...], Meta(max_length=256)] = ()
    start_time: Name | None = None
    source: Text = ""
    licence: Text = ""
    message: Text = ""
    label: Name = ""
    pinned: bool = False
    forcing_revision: Revision = 0
    moves: Annotated[tuple[Name, ...], Meta(max_length=64)] = ()
    channels: Channels = ()
    layers: Layers = ()


class RunList(Message, frozen=True):
    """Answer to `list_runs`.

    Attributes:
        id: id of the command.
        runs: the runs, newest first; up to 1000.
    """

    id: CommandId
    runs: tuple[RunInfo, ...]


class RunChanged(Message, frozen=True):
    """A run is new or has changed its status.

    Attributes:
        run: the run as it is now.
    """

    run: RunInfo


class RunBranched(Message, frozen=True):
    """Somebody recalculated: a child of a watched run exists.

    Attributes:
        parent: id of the parent.
        child: the new run.
    """

    parent: Identifier
    child: RunInfo


class RunRemoved(Message, frozen=True):
    """A run is deleted; its frames are gone.

    Attributes:
        run: id of the run.
    """

    run: Identifier
