"""The edit being drawn: points set so far, the rubber band to the pointer, and what it will become."""

from __future__ import annotations

import dataclasses
import math
import uuid
from collections.abc import Callable, Sequence

import protocol
from viewer.commands import ChangeEditSettings, CommandError
from viewer.view_status import EditSettings
from viewer.world.polyline import Place, simplified

__all__ = ["KINDS", "EditDrawing", "changed_settings", "new_edit", "new_edit_id"]

GroundAt = Callable[[float, float], float]
KINDS = ("line", "area")
OPERATIONS = tuple(str(operation) for operation in protocol.Operation)
TYPES = tuple(str(kind) for kind in protocol.EditType)
STROKE_TOLERANCE_CELLS = 0.5
"""Farthest that a point of a stroke which is left out may lie from the line."""


class EditDrawing:
    """State of the drawing tool.

    Attributes:
        is_on: whether the tool is in the user's hand.
        kind: "line" or "area".
        vertices: points set so far (x, y) [m].
        hover: the point under the pointer, None when it is off the terrain.
        settings: what the edit will be.
    """

    def __init__(self) -> None:
        self.is_on = False
        self.kind = "line"
        self.vertices: list[Place] = []
        self.hover: Place | None = None
        self.settings = EditSettings()
        self._stroke_start: int | None = None

    def begin(self, kind: str = "line") -> None:
        """Take the tool, with no point set.

        Raises:
            CommandError: an unknown kind of edit.
        """
        if kind not in KINDS:
            raise CommandError(f"edit kind {kind!r} is not allowed; allowed are {', '.join(KINDS)}")
        self.put_away()
        self.is_on, self.kind = True, kind

    def put_away(self) -> None:
        """Drop what is drawn and the tool."""
        self.is_on = False
        self.vertices.clear()
        self.hover = None
        self._stroke_start = None

    def add_vertex(self, x: float, y: float, grid: protocol.GridGeometry) -> None:
        """Set a point.

        Raises:
            CommandError: the point is outside the terrain, or one too many.
        """
        if not grid.contains(x, y):
            raise CommandError(f"the point ({x:.1f}, {y:.1f}) is outside the terrain")
        if len(self.vertices) >= protocol.limits.MAX_VERTICES:
            raise CommandError(f"an edit has up to {protocol.limits.MAX_VERTICES} points; finish this one")
        if not self.vertices or self.vertices[-1] != (x, y):
            self.vertices.append((x, y))

    def closes(self, x: float, y: float, reach: float) -> bool:
        """Whether a point `reach` [m] around is the first one of an area with all its corners."""
        return (
            self.kind == "area" and len(self.vertices) >= 3 and math.dist(self.vertices[0], (x, y)) <= reach
        )

    def drop_vertex(self) -> None:
        """Take the last point off again."""
        if self.vertices:
            self.vertices.pop()
        self._stroke_start = None

    def stroke_to(self, x: float, y: float, grid: protocol.GridGeometry) -> None:
        """Draw free-hand to a point; the stroke begins at the last point set."""
        if self._stroke_start is None:
            self._stroke_start = max(0, len(self.vertices) - 1)
        self.add_vertex(x, y, grid)
        self.hover = None

    def end_stroke(self, grid: protocol.GridGeometry) -> None:
        """Leave out the points of the stroke that do not matter to its shape."""
        if self._stroke_start is None:
            return
        start, self._stroke_start = self._stroke_start, None
        self.vertices[start:] = simplified(self.vertices[start:], STROKE_TOLERANCE_CELLS * grid.dx)

    def edit(self, ground: GroundAt, *, with_hover: bool) -> protocol.Edit | None:
        """Return what is drawn as an edit, None while it has too few points.

        Args:
            ground: ground elevation before the edit at a point [m, datum-relative].
            with_hover: count the point under the pointer as the last one.
        """
        points = list(self.vertices)
        if with_hover and self.hover is not None and points and points[-1] != self.hover:
            points.append(self.hover)
        if len(points) < (2 if self.kind == "line" else 3):
            return None
        settings = self.settings
        kind = protocol.EditType(settings.type)
        level = settings.level if kind is protocol.EditType.replace and settings.at_level else None
        needs_ground = kind is protocol.EditType.replace and level is None
        return new_edit(
            self.kind,
            points,
            width=settings.width,
            operation=protocol.Operation(settings.operation),
            type=kind,
            magnitude=settings.magnitude,
            level=level,
            reference_z=tuple(ground(x, y) for x, y in points) if needs_ground else None,
        )


def changed_settings(settings: EditSettings, command: ChangeEditSettings) -> EditSettings:
    """Return the settings with those that a command names.

    Raises:
        CommandError: a width or magnitude that is not above 0, an unknown operation or type.
    """
    given = {
        field.name: value
        for field in dataclasses.fields(settings)
        if (value := getattr(command, field.name)) is not None
    }
    for name in ("width", "magnitude"):
        if name in given and not (given[name] > 0.0 and math.isfinite(given[name])):
            raise CommandError(f"edit {name} {given[name]!r} is not allowed; it must be above 0 m")
    if "level" in given and not abs(given["level"]) <= 20_000.0:
        raise CommandError(f"edit level {given['level']!r} is not allowed; -20000 to 20000 m is")
    for name, allowed in (("operation", OPERATIONS), ("type", TYPES)):
        if name in given and given[name] not in allowed:
            raise CommandError(
                f"edit {name} {given[name]!r} is not allowed; allowed are {', '.join(allowed)}"
            )
    return dataclasses.replace(settings, **given)


def new_edit_id() -> str:
    """Return an id that no edit has."""
    return f"edit-{uuid.uuid4().hex[:12]}"


def new_edit(
    kind: str,
    points: Sequence[Place],
    *,
    width: float,
    operation: protocol.Operation,
    type: protocol.EditType,
    magnitude: float,
    level: float | None,
    reference_z: tuple[float, ...] | None,
    name: str = "",
    id: str | None = None,
) -> protocol.Edit:
    """Return an edit of a kind, with a new id unless one is given.

    Raises:
        ValueError: a number that is not finite, or points and reference that do not fit.
    """
    id = new_edit_id() if id is None else id
    vertices = tuple(points)
    if kind == "area":
        return protocol.EditArea(id, vertices, operation, type, magnitude, level, reference_z, name)
    return protocol.EditLine(id, vertices, width, operation, type, magnitude, level, reference_z, name)
