"""What an edit becomes when it is moved, renamed or given other numbers."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

import protocol
from viewer.app.edit_drawing import changed_settings, new_edit
from viewer.commands import ChangeEditSettings, CommandError
from viewer.view_status import EditSettings
from viewer.world.polyline import Place

__all__ = ["altered", "moved", "renamed", "settings_of", "with_vertex"]

GroundAt = Callable[[float, float], float]


def settings_of(edit: protocol.Edit) -> EditSettings:
    """Return the numbers of an edit."""
    return EditSettings(
        width=edit.width if isinstance(edit, protocol.EditLine) else EditSettings().width,
        magnitude=edit.magnitude,
        operation=str(edit.operation),
        type=str(edit.type),
        level=0.0 if edit.level is None else edit.level,
        at_level=edit.level is not None,
    )


def moved(
    edit: protocol.Edit, dx: float, dy: float, grid: protocol.GridGeometry, ground: GroundAt
) -> protocol.Edit:
    """Return an edit moved by (dx, dy) [m], no farther than the terrain goes.

    Args:
        edit: the edit.
        dx: to the east [m].
        dy: to the north [m].
        grid: geometry of the terrain.
        ground: ground before the edit at a point [m, datum-relative]: a crest above it goes with it.
    """
    xmin, ymin, xmax, ymax = grid.extent
    xs, ys = [x for x, _ in edit.vertices], [y for _, y in edit.vertices]
    dx = min(max(dx, xmin - min(xs)), xmax - max(xs))
    dy = min(max(dy, ymin - min(ys)), ymax - max(ys))
    # The clamp again: a sum of rounded numbers may pass the border by its last bit.
    places = [(_within(x + dx, xmin, xmax), _within(y + dy, ymin, ymax)) for x, y in edit.vertices]
    return _at(edit, tuple(places), ground)


def with_vertex(
    edit: protocol.Edit, number: int, at: Place, grid: protocol.GridGeometry, ground: GroundAt
) -> protocol.Edit:
    """Return an edit with one vertex elsewhere, within the terrain; see `moved`.

    Raises:
        CommandError: the edit has no such vertex.
    """
    if not 0 <= number < len(edit.vertices):
        raise CommandError(f"vertex {number} is not allowed; the edit has 0 to {len(edit.vertices) - 1}")
    xmin, ymin, xmax, ymax = grid.extent
    place = (_within(at[0], xmin, xmax), _within(at[1], ymin, ymax))
    return _at(edit, (*edit.vertices[:number], place, *edit.vertices[number + 1 :]), ground)


def renamed(edit: protocol.Edit, name: str) -> protocol.Edit:
    """Return an edit with another name."""
    return msgspec.structs.replace(edit, name=name.strip()[:100])


def altered(edit: protocol.Edit, command: ChangeEditSettings, ground: GroundAt) -> protocol.Edit:
    """Return an edit with the numbers that a command names; `ground` as in `moved`.

    Raises:
        CommandError: a number or word that is not allowed.
    """
    before = settings_of(edit)
    after = changed_settings(before, command)
    kind = protocol.EditType(after.type)
    level = after.level if kind is protocol.EditType.replace and after.at_level else None
    reference = edit.reference_z
    if kind is not protocol.EditType.replace or level is not None:
        reference = None
    elif reference is None:
        reference = tuple(ground(x, y) for x, y in edit.vertices)
    return new_edit(
        "line" if isinstance(edit, protocol.EditLine) else "area",
        edit.vertices,
        width=after.width,
        operation=protocol.Operation(after.operation),
        type=kind,
        magnitude=after.magnitude,
        level=level,
        reference_z=reference,
        name=edit.name,
        id=edit.id,
    )


def _at(edit: protocol.Edit, vertices: tuple[Place, ...], ground: GroundAt) -> protocol.Edit:
    reference = edit.reference_z
    if reference is not None:
        reference = tuple(ground(x, y) for x, y in vertices)
    return msgspec.structs.replace(edit, vertices=vertices, reference_z=reference)


def _within(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)
