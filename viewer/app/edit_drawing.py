"""The edit line being drawn: points set so far, the rubber band to the pointer, and what it will become."""

from __future__ import annotations

import dataclasses
import uuid
from collections.abc import Callable

import protocol
from viewer.commands import ChangeEditSettings, CommandError
from viewer.view_status import EditSettings

__all__ = ["EditDrawing", "edit_text"]

GroundAt = Callable[[float, float], float]
OPERATIONS = tuple(str(operation) for operation in protocol.Operation)
TYPES = tuple(str(kind) for kind in protocol.EditType)


class EditDrawing:
    """State of the edit tool.

    Attributes:
        is_on: whether the tool is in the user's hand.
        vertices: points set so far (x, y) [m].
        hover: the point under the pointer, None when it is off the terrain.
        settings: what the line will be.
    """

    def __init__(self) -> None:
        self.is_on = False
        self.vertices: list[tuple[float, float]] = []
        self.hover: tuple[float, float] | None = None
        self.settings = EditSettings()

    def begin(self) -> None:
        """Take the tool, with no point set."""
        self.is_on = True
        self.vertices.clear()
        self.hover = None

    def put_away(self) -> None:
        """Drop the line and the tool."""
        self.is_on = False
        self.vertices.clear()
        self.hover = None

    def change(self, command: ChangeEditSettings) -> None:
        """Take over the settings that the command names.

        Raises:
            CommandError: a width or magnitude that is not above 0, an unknown operation or type.
        """
        given = {
            name: value
            for name in ("width", "magnitude", "operation", "type")
            if (value := getattr(command, name)) is not None
        }
        for name in ("width", "magnitude"):
            if name in given and not given[name] > 0.0:
                raise CommandError(f"edit {name} {given[name]!r} is not allowed; it must be above 0 m")
        for name, allowed in (("operation", OPERATIONS), ("type", TYPES)):
            if name in given and given[name] not in allowed:
                raise CommandError(
                    f"edit {name} {given[name]!r} is not allowed; allowed are {', '.join(allowed)}"
                )
        self.settings = dataclasses.replace(self.settings, **given)

    def add_vertex(self, x: float, y: float, grid: protocol.GridGeometry) -> None:
        """Set a point.

        Raises:
            CommandError: the point is outside the terrain.
        """
        if not grid.contains(x, y):
            raise CommandError(f"the point ({x:.1f}, {y:.1f}) is outside the terrain")
        if not self.vertices or self.vertices[-1] != (x, y):
            self.vertices.append((x, y))

    def line(self, ground: GroundAt, *, with_hover: bool) -> protocol.EditLine | None:
        """Return the line as an edit, None while it has fewer than two points.

        Args:
            ground: ground elevation before the edit at a point [m, datum-relative].
            with_hover: count the point under the pointer as the last one.
        """
        points = list(self.vertices)
        if with_hover and self.hover is not None and points and points[-1] != self.hover:
            points.append(self.hover)
        if len(points) < 2:
            return None
        settings = self.settings
        kind = protocol.EditType(settings.type)
        reference = tuple(ground(x, y) for x, y in points) if kind is protocol.EditType.replace else None
        return protocol.EditLine(
            id=f"edit-{uuid.uuid4().hex[:12]}",
            vertices=tuple(points),
            width=settings.width,
            operation=protocol.Operation(settings.operation),
            type=kind,
            magnitude=settings.magnitude,
            reference_z=reference,
        )


def edit_text(edit: protocol.Edit) -> str:
    """Return an edit in words, for the list of edits."""
    verb = "Raise" if edit.operation is protocol.Operation.raise_ else "Lower"
    if edit.type is protocol.EditType.modulate:
        change = f"by {edit.magnitude:g} m"
    elif edit.level is not None:
        change = f"to {edit.level:g} m"
    else:
        change = f"to an even {edit.magnitude:g} m"
    if isinstance(edit, protocol.EditArea):
        return f"{verb} area {change}"
    return f"{verb} {change}, {edit.width:g} m wide, {len(edit.vertices)} points"
