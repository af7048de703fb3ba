"""What is shown of the edits: their marks on the picture, their rows in the panel."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import msgspec

import protocol
from viewer.app.edit_alteration import settings_of
from viewer.app.editing import Editing
from viewer.app.levee_watch import LeveeWatch, Overtopping
from viewer.app.shown_run import ShownRun
from viewer.render import DrapedLine, EditOverlay, LineStyle
from viewer.units import Units
from viewer.view_status import EditRow, time_text
from viewer.world import EditMeasure

__all__ = ["edit_overlay", "edit_rows", "edit_text", "undone_rows"]


def edit_overlay(shown: ShownRun, editing: Editing | None) -> EditOverlay | None:
    """Return the marks of the working list and of what is drawn or moved; None when there is neither.

    Args:
        shown: the run.
        editing: the edit tool; None where nothing is edited.
    """
    preview, document = shown.document.preview(), shown.document
    lines = []
    for listed in document.edits:
        is_moving = document.draft is not None and document.draft.id == listed.id
        edit = document.draft if is_moving and document.draft is not None else listed
        style = LineStyle.RAISE if edit.operation is protocol.Operation.raise_ else LineStyle.LOWER
        if editing is not None and edit.id == editing.selection.selected:
            style = LineStyle.SELECTED
        width = edit.width if isinstance(edit, protocol.EditLine) else shown.grid.dx
        lines.append(DrapedLine(_path(edit), width, style))
    drawing = None if editing is None else editing.drawing
    if drawing is not None and drawing.is_on and drawing.vertices:
        points = list(drawing.vertices)
        if drawing.hover is not None:
            points.append(drawing.hover)
        is_area = drawing.kind == "area"
        if is_area and len(points) >= 3:
            points.append(points[0])
        width = shown.grid.dx if is_area else drawing.settings.width
        lines.append(DrapedLine(tuple(points), width, LineStyle.DRAFT))
    if not lines and preview.revision == 0:
        return None
    return EditOverlay(shown.overlay_revision(), preview.sign, tuple(lines))


def edit_rows(
    shown: ShownRun, applied: Sequence[protocol.Edit], watch: LeveeWatch, units: Units
) -> tuple[EditRow, ...]:
    """Return the working list for the edit panel.

    Args:
        shown: the run with the list.
        applied: the edits that the run was computed with.
        watch: knows the measures, and what was overtopped.
        units: units to write.
    """
    beds = {_nameless(edit) for edit in applied}
    rows = []
    for edit, measure in zip(shown.document.edits, watch.measures(shown), strict=True):
        row = _row(edit, units, is_applied=_nameless(edit) in beds)
        warning = _warning_text(watch.overtopping(shown, edit))
        rows.append(dataclasses.replace(row, measure=_measure_text(measure, units), warning=warning))
    return tuple(rows)


def undone_rows(shown: ShownRun, units: Units) -> tuple[EditRow, ...]:
    """Return the edits that redoing would bring back, the next one first."""
    return tuple(_row(edit, units, is_applied=False) for edit in shown.document.undone)


def edit_text(edit: protocol.Edit, units: Units) -> str:
    """Return an edit in words, for the list of edits."""
    verb = "Raise" if edit.operation is protocol.Operation.raise_ else "Lower"
    if edit.type is protocol.EditType.modulate:
        change = f"by {_short(edit.magnitude, units)}"
    elif edit.level is not None:
        change = f"to {units.length_text(edit.level)}"
    else:
        change = f"to an even {_short(edit.magnitude, units)}"
    if isinstance(edit, protocol.EditArea):
        return f"{verb} area {change}"
    return f"{verb} {change}, {_short(edit.width, units)} wide, {len(edit.vertices)} points"


def _row(edit: protocol.Edit, units: Units, *, is_applied: bool) -> EditRow:
    xs, ys = zip(*edit.vertices, strict=True)
    return EditRow(
        edit.id,
        edit_text(edit, units),
        is_applied,
        name=edit.name,
        kind="line" if isinstance(edit, protocol.EditLine) else "area",
        settings=settings_of(edit),
        centre=(0.5 * (min(xs) + max(xs)), 0.5 * (min(ys) + max(ys))),
    )


def _nameless(edit: protocol.Edit) -> protocol.Edit:
    return msgspec.structs.replace(edit, name="")


def _path(edit: protocol.Edit) -> tuple[tuple[float, float], ...]:
    return (*edit.vertices, edit.vertices[0]) if isinstance(edit, protocol.EditArea) else edit.vertices


def _short(metres: float, units: Units) -> str:
    return f"{units.shown(metres):g} {units.length}"


def _measure_text(measure: EditMeasure, units: Units) -> str:
    moved = "fill" if measure.volume >= 0.0 else "cut"
    return f"{units.distance_text(measure.length)} long, {units.volume_text(abs(measure.volume))} of {moved}"


def _warning_text(overtopping: Overtopping | None) -> str:
    if overtopping is None:
        return ""
    return f"overtopped at {time_text(overtopping.time)} near x {overtopping.x:.0f}, y {overtopping.y:.0f}"
