"""Which edit of the working list is selected, and what of it is in hand."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import protocol
from viewer.app.edit_alteration import moved, with_vertex
from viewer.world.polyline import Place, distance_to_line, is_within, nearest_vertex

__all__ = ["EditSelection", "edit_at"]

GroundAt = Callable[[float, float], float]


class EditSelection:
    """State of the select tool.

    Attributes:
        is_on: whether the tool is in the user's hand.
        selected: id of the selected edit.
        moving: the edit in hand as it is now; None when nothing is in hand.
    """

    def __init__(self) -> None:
        self.is_on = False
        self.selected: str | None = None
        self.moving: protocol.Edit | None = None
        self._held: protocol.Edit | None = None
        self._vertex: int | None = None
        self._from: Place = (0.0, 0.0)
        self._ground: GroundAt | None = None

    def grab(
        self,
        edits: Sequence[protocol.Edit],
        at: Place,
        reach: float,
        ground_before: Callable[[str], GroundAt],
    ) -> None:
        """Select the edit at a place and take hold of it, or of its vertex there; select none on bare ground.

        Args:
            edits: the working list.
            at: x and y [m].
            reach: how near is near enough [m].
            ground_before: gives the ground before the edit of an id.
        """
        self.release()
        before = next((edit for edit in edits if edit.id == self.selected), None)
        found = before if before is not None and _touches(before, at, reach) else edit_at(edits, at, reach)
        self.selected = None if found is None else found.id
        if found is None:
            return
        vertex, away = nearest_vertex(found.vertices, at)
        self._held, self._from = found, at
        self._vertex = vertex if away <= reach else None
        self._ground = ground_before(found.id)

    def drag(self, at: Place, grid: protocol.GridGeometry) -> None:
        """Move what is in hand to a place."""
        if self._held is None or self._ground is None:
            return
        if self._vertex is not None:
            self.moving = with_vertex(self._held, self._vertex, at, grid, self._ground)
        else:
            by = (at[0] - self._from[0], at[1] - self._from[1])
            self.moving = moved(self._held, *by, grid, self._ground)

    def release(self) -> protocol.Edit | None:
        """Let go; return the edit as it is to be, None when it has not moved."""
        result = self.moving if self.moving != self._held else None
        self.moving = self._held = self._vertex = self._ground = None
        return result

    def put_away(self) -> None:
        """Put the tool away and let go; nothing has moved then, and nothing is selected."""
        self.release()
        self.is_on = False
        self.selected = None


def edit_at(edits: Sequence[protocol.Edit], at: Place, reach: float) -> protocol.Edit | None:
    """Return the edit at a place: the nearest line or border, the newest of those on whose ground it is."""
    found = [
        (_away(edit, at), -number, edit) for number, edit in enumerate(edits) if _touches(edit, at, reach)
    ]
    return min(found, key=lambda one: one[:2])[2] if found else None


def _touches(edit: protocol.Edit, at: Place, reach: float) -> bool:
    return _away(edit, at) <= reach


def _away(edit: protocol.Edit, at: Place) -> float:
    """Distance to the ground that an edit covers [m], 0 on it."""
    if isinstance(edit, protocol.EditArea):
        if is_within(edit.vertices, at):
            return 0.0
        return distance_to_line((*edit.vertices, edit.vertices[0]), at)
    return max(0.0, distance_to_line(edit.vertices, at) - 0.5 * edit.width)
