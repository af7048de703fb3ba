"""What is written on the picture and shown beside it."""

from __future__ import annotations

import protocol
from viewer.app.recalculation import Recalculation
from viewer.app.shown_run import ShownRun
from viewer.render import HudText
from viewer.view_status import PointReadout, clock_text, time_text
from viewer.world import ProbeReading

__all__ = ["hud_text", "loss_notice", "only_warnings", "readout"]


def hud_text(
    shown: ShownRun,
    time: float,
    progress: protocol.Progress | None,
    recalculated: Recalculation | None,
    notice: str,
    measured: str = "",
) -> HudText:
    """Return the text of the picture.

    Args:
        shown: the run on it.
        time: its simulation time [s].
        progress: the newest progress of the run, if there is any.
        recalculated: the newest recalculation, if there is any.
        notice: a warning.
        measured: what the measuring tool says.
    """
    info = shown.info
    lines = [f"{info.status}, computed until {time_text(shown.computed_until)} on {info.device}"]
    if progress is not None:
        lines.append(
            f"{progress.speed_x_real_time:.0f} x real time, volume error {progress.volume_error_relative:.1e}"
        )
    if info.branch_index is not None:
        lines.append(f"recalculated from {time_text(info.branch_index * info.output_interval)}")
    if recalculated is not None and recalculated.child == info.run and recalculated.first_frame_s is not None:
        lines[-1] += f", first frame after {recalculated.first_frame_s:.2f} s"
    if measured:
        lines.append(f"measured: {measured}")
    return HudText(
        title=info.title,
        time="   ".join(filter(None, (time_text(time), clock_text(info.start_time, time)))),
        detail="\n".join(lines),
        is_hypothetical=info.hypothetical,
        notice=notice,
    )


def only_warnings(text: HudText) -> HudText:
    """Return what is told on every picture: that an event is hypothetical, and that the data is old."""
    return HudText(
        legend=False, scale_and_north=False, is_hypothetical=text.is_hypothetical, notice=text.notice
    )


def loss_notice(connection: str, data_age: float | None) -> str:
    """Return what the picture says while the service is gone.

    Args:
        connection: what the connection does, with the countdown to the next attempt.
        data_age: time since the service was last heard [s]; None when it never was.
    """
    age = "" if data_age is None else f"\nThis picture is {time_text(data_age)} old."
    return f"{connection}{age}"


def readout(reading: ProbeReading | None) -> PointReadout | None:
    """Return a probe reading for the panels."""
    if reading is None:
        return None
    return PointReadout(reading.x, reading.y, reading.ground, reading.depth, reading.level)
