"""What is written on the picture and shown beside it."""

from __future__ import annotations

from collections.abc import Sequence

import protocol
from viewer.app.edit_drawing import EditDrawing, edit_text
from viewer.app.levee_watch import LeveeWatch, Overtopping
from viewer.app.recalculation import Recalculation
from viewer.app.shown_run import ShownRun
from viewer.render import DrapedLine, EditOverlay, HudText, LineStyle
from viewer.view_status import EditRow, PointReadout, clock_text, time_text
from viewer.world import EditMeasure, ProbeReading

__all__ = ["edit_overlay", "edit_rows", "hud_text", "loss_notice", "readout"]


def hud_text(
    shown: ShownRun,
    time: float,
    progress: protocol.Progress | None,
    recalculated: Recalculation | None,
    notice: str,
) -> HudText:
    """Return the text of the picture."""
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
    return HudText(
        title=info.title,
        time="   ".join(filter(None, (time_text(time), clock_text(info.start_time, time)))),
        detail="\n".join(lines),
        is_hypothetical=info.hypothetical,
        notice=notice,
    )


def loss_notice(connection: str, data_age: float | None) -> str:
    """Return what the picture says while the service is gone.

    Args:
        connection: what the connection does, with the countdown to the next attempt.
        data_age: time since the service was last heard [s]; None when it never was.
    """
    age = "" if data_age is None else f"\nThis picture is {time_text(data_age)} old."
    return f"{connection}{age}"


def edit_overlay(shown: ShownRun, drawing: EditDrawing) -> EditOverlay | None:
    """Return the marks of the working list and of the line being drawn; None when there is neither."""
    preview = shown.document.preview()
    lines = [
        DrapedLine(
            tuple(edit.vertices) + ((edit.vertices[0],) if isinstance(edit, protocol.EditArea) else ()),
            edit.width if isinstance(edit, protocol.EditLine) else shown.grid.dx,
            LineStyle.RAISE if edit.operation is protocol.Operation.raise_ else LineStyle.LOWER,
        )
        for edit in shown.document.edits
    ]
    if drawing.is_on and drawing.vertices:
        points = list(drawing.vertices)
        if drawing.hover is not None:
            points.append(drawing.hover)
        if len(points) >= 2:
            lines.append(DrapedLine(tuple(points), drawing.settings.width, LineStyle.DRAFT))
    if not lines and preview.revision == 0:
        return None
    return EditOverlay(shown.overlay_revision(), preview.sign, tuple(lines))


def edit_rows(shown: ShownRun, applied: Sequence[protocol.Edit], watch: LeveeWatch) -> tuple[EditRow, ...]:
    """Return the working list for the edit panel.

    Args:
        shown: the run with the list.
        applied: the edits that the run was computed with.
        watch: knows the measures, and what was overtopped.
    """
    applied_ids = {edit.id for edit in applied}
    return tuple(
        EditRow(
            edit.id,
            edit_text(edit),
            edit.id in applied_ids,
            _measure_text(measure),
            _warning_text(watch.overtopping(shown, edit.id)),
        )
        for edit, measure in zip(shown.document.edits, watch.measures(shown), strict=True)
    )


def _measure_text(measure: EditMeasure) -> str:
    moved = "fill" if measure.volume >= 0.0 else "cut"
    return f"{measure.length:,.0f} m long, {abs(measure.volume):,.0f} m\u00b3 of {moved}"


def _warning_text(overtopping: Overtopping | None) -> str:
    if overtopping is None:
        return ""
    return f"overtopped at {time_text(overtopping.time)} near x {overtopping.x:.0f}, y {overtopping.y:.0f}"


def readout(reading: ProbeReading | None) -> PointReadout | None:
    """Return a probe reading for the panels."""
    if reading is None:
        return None
    return PointReadout(reading.x, reading.y, reading.ground, reading.depth, reading.level)
