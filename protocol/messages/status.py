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
        limiting_cell: row and column of the cell that limits dt, if known.
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
