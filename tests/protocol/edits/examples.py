"""Short ways to write an edit."""

from collections.abc import Sequence

from protocol import EditArea, EditLine, EditType, Operation

Points = Sequence[tuple[float, float]]


def line(
    vertices: Points,
    width: float = 2.0,
    *,
    id: str = "e",
    operation: str = "raise",
    type: str = "modulate",
    magnitude: float = 1.0,
    level: float | None = None,
    reference_z: Sequence[float] | None = None,
) -> EditLine:
    reference = None if reference_z is None else tuple(reference_z)
    return EditLine(
        id, tuple(vertices), width, Operation(operation), EditType(type), magnitude, level, reference
    )


def area(
    vertices: Points,
    *,
    id: str = "a",
    operation: str = "raise",
    type: str = "modulate",
    magnitude: float = 1.0,
    level: float | None = None,
    reference_z: Sequence[float] | None = None,
) -> EditArea:
    reference = None if reference_z is None else tuple(reference_z)
    return EditArea(id, tuple(vertices), Operation(operation), EditType(type), magnitude, level, reference)
