"""Answers, progress and notices of the service."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta, field

from protocol.fields import (
    CommandId,
    Count,
    ErrorName,
    FrameIndex,
    Identifier,
    Message,
    Name,
    NotNegative,
    Text,
)

Scalar = bool | int | float | Annotated[str, Meta(max_length=2000)] | None


class Ack(Message, frozen=True):
    """A command was carried out.

    Attributes:
        id: id of the command.
        result: what the command gives back, if anything: result.run of `start_run` and `recalculate`,
            result.revision of the edit commands.
    """

    id: CommandId
    result: Annotated[dict[Name, Scalar], Meta(max_length=64)] = field(default_factory=dict)


class Error(Message, frozen=True):
    """A command was refused and changed nothing, or (without an id) the connection is about to close.

    Attributes:
        id: id of the command, or none.
        code: stable name of what went wrong.
        message: one sentence for people.
    """

    id: CommandId | None
    code: ErrorName
    message: Text


class Progress(Message, frozen=True):
    """How a run is getting on; sent at most a few times a second, may be skipped.

    Attributes:
        run: id of the run.
        time: simulated time [s].
        steps: solver steps so far.
        dt: latest time step [s].
        speed_x_real_time: simulated over wall time.
        wall_s: wall time spent computing [s].
        cell_steps_per_s: cells times steps over wall time [1/s].
        volume_error_relative: water volume error over the volume.
        wet_cells: cells with water.
        limiting_cell: row and column of the cell that limited dt at the last frame, if known.
        eta_s: wall time until the run is finished at the pace of this stretch [s], if known.
    """

    run: Identifier
    time: NotNegative
    steps: Count
    dt: NotNegative
    speed_x_real_time: NotNegative
    wall_s: NotNegative
    cell_steps_per_s: NotNegative
    volume_error_relative: float
    wet_cells: Count
    limiting_cell: tuple[FrameIndex, FrameIndex] | None = None
    eta_s: NotNegative | None = None


Volumes = Annotated[dict[Name, float], Meta(max_length=4096)]


class WaterBudget(Message, frozen=True):
    """Where the water of a run came from and went, since its beginning [m3]; follows a frame.

    error = stored - (initial + inflow + rain - infiltration - outflow - edits)

    Attributes:
        run: id of the run.
        time: simulated time [s].
        initial: water at the beginning.
        stored: water now.
        inflow: brought by sources, edges and structures.
        outflow: left through edges and structures.
        rain: brought by rain.
        infiltration: gone into the ground.
        edits: cut by raising the bed under water.
        error: what nothing explains.
        error_relative: the error in units of all the water there ever was [1].
        sources: brought by each source.
        edges_in: come in through each edge.
        edges_out: gone out through each edge.
        structures: taken out of the domain by each structure; negative for what it brought.
        moved: moved within the domain by each structure.
    """

    run: Identifier
    time: NotNegative
    initial: float
    stored: float
    inflow: float
    outflow: float
    rain: float
    infiltration: float
    edits: float
    error: float
    error_relative: float
    sources: Volumes = field(default_factory=dict)
    edges_in: Volumes = field(default_factory=dict)
    edges_out: Volumes = field(default_factory=dict)
    structures: Volumes = field(default_factory=dict)
    moved: Volumes = field(default_factory=dict)


class Notice(Message, frozen=True):
    """Something a person should read.

    Attributes:
        level: how grave it is.
        text: one sentence.
        run: id of the run it is about, if any.
    """

    level: Literal["info", "warning", "error"]
    text: Text
    run: Identifier | None = None
