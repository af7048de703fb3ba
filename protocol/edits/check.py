"""Whether an edit can be applied to a terrain."""

from __future__ import annotations

import msgspec

from protocol.edits.model import Edit, EditLine
from protocol.edits.raster import rasterise_edit
from protocol.errors import EditError
from protocol.fields import plain
from protocol.grid import GridGeometry


def check_edit(edit: Edit, grid: GridGeometry) -> None:
    """Refuse an edit that breaks a rule of its own or does not fit the terrain.

    An edit made in code has not been through the codec, so its fields are checked here too.

    Args:
        edit: the edit.
        grid: the terrain's grid.

    Raises:
        EditError: naming the edit, the field, its value and what is allowed.
    """
    try:
        msgspec.convert(plain(edit), type(edit))
    except msgspec.ValidationError as error:
        raise EditError(f"Edit {edit.id!r} is not valid: {error}.") from error
    if isinstance(edit, EditLine) and len(set(edit.vertices)) < 2:
        raise EditError(
            f"Edit {edit.id!r} has all its vertices at one point; a line of some length is allowed."
        )
    if rasterise_edit(edit, grid)[0].size == 0:
        raise EditError(
            f"Edit {edit.id!r} covers no cell centre; draw it at least one cell ({grid.dx:g} m) wide."
        )
