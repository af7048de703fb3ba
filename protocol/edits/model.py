"""Terrain edits as they are drawn, stored and sent: vectors, never pixels."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated, ClassVar

from msgspec import Meta

from protocol.fields import Coordinate, Elevation, Identifier, WireStruct
from protocol.limits import MAX_VERTICES

Vertex = tuple[Coordinate, Coordinate]
Magnitude = Annotated[float, Meta(gt=0, le=10_000)]
Width = Annotated[float, Meta(gt=0, le=100_000)]
EditName = Annotated[str, Meta(max_length=100)]


class Operation(StrEnum):
    """Which way the ground goes: s = +1 for raise, -1 for lower."""

    raise_ = "raise"
    # The wire name hides a method of str, which nobody calls on an operation.
    lower = "lower"  # type: ignore[assignment]

    @property
    def sign(self) -> int:
        """The s of the formulas."""
        return 1 if self is Operation.raise_ else -1


class EditType(StrEnum):
    """Whether the ground follows its old shape (modulate) or takes a new one (replace)."""

    modulate = "modulate"
    replace = "replace"  # type: ignore[assignment]


class EditLine(WireStruct, frozen=True, tag_field="kind", tag="line"):
    """A levee, wall, road or trench along a line.

    Attributes:
        id: id of the edit, unique in its list.
        vertices: x and y [m] of 2 to 4096 points.
        width: full width across the line [m].
        operation: raise or lower.
        type: modulate or replace.
        magnitude: height or depth m [m].
        level: real elevation of the crest or bottom [m] for replace; wins over reference_z.
        reference_z: ground z_b [m, relative to datum_offset] at each vertex when it was drawn, for replace.
        name: the name that people gave it.
    """

    left_out: ClassVar[tuple[str, ...]] = ("name",)

    id: Identifier
    vertices: Annotated[tuple[Vertex, ...], Meta(min_length=2, max_length=MAX_VERTICES)]
    width: Width
    operation: Operation
    type: EditType
    magnitude: Magnitude
    level: Elevation | None = None
    reference_z: Annotated[tuple[Elevation, ...], Meta(max_length=MAX_VERTICES)] | None = None
    name: EditName = ""

    def __post_init__(self) -> None:
        """Refuse a reference that does not fit the vertices."""
        super().__post_init__()
        _check_reference(self)


class EditArea(WireStruct, frozen=True, tag_field="kind", tag="area"):
    """A platform, pit or filled street: a polygon.

    Attributes:
        id: id of the edit, unique in its list.
        vertices: x and y [m] of the 3 to 4096 corners of one ring; the last is joined to the first.
        operation: raise or lower.
        type: modulate or replace.
        magnitude: height or depth m [m].
        level: real elevation of the top or bottom [m] for replace; wins over reference_z.
        reference_z: ground z_b [m, relative to datum_offset] at each corner when it was drawn;
            the mean counts.
        name: the name that people gave it.
    """

    left_out: ClassVar[tuple[str, ...]] = ("name",)

    id: Identifier
    vertices: Annotated[tuple[Vertex, ...], Meta(min_length=3, max_length=MAX_VERTICES)]
    operation: Operation
    type: EditType
    magnitude: Magnitude
    level: Elevation | None = None
    reference_z: Annotated[tuple[Elevation, ...], Meta(max_length=MAX_VERTICES)] | None = None
    name: EditName = ""

    def __post_init__(self) -> None:
        """Refuse a reference that does not fit the vertices."""
        super().__post_init__()
        _check_reference(self)


Edit = EditLine | EditArea


def _check_reference(edit: EditLine | EditArea) -> None:
    if edit.reference_z is not None and len(edit.reference_z) != len(edit.vertices):
        raise ValueError(
            f"Edit {edit.id!r} has {len(edit.reference_z)} values of 'reference_z';"
            f" one for each of its {len(edit.vertices)} vertices is allowed"
        )
    if edit.type is EditType.replace and edit.level is None and edit.reference_z is None:
        raise ValueError(f"Edit {edit.id!r} is of type 'replace'; it needs 'level' or 'reference_z'")
