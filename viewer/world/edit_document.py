"""The user's terrain edits as the viewer knows them: the service's list, and the edit being drawn.

The preview goes through `protocol.apply_edits`, the very code the solver runs, so what is shown before
Recalculate is what will be computed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from protocol import Edit, EditError, GridGeometry, apply_edits, rasterise_edit
from viewer.world.heightfield import Heightfield, Rect, union_rect

__all__ = ["EditDocument", "EditPreview"]


@dataclass(frozen=True)
class EditPreview:
    """The ground with all edits on it."""

    z_b: npt.NDArray[np.float32]
    """Edited bed [m, datum-relative], shape [nrows, ncols]."""
    sign: npt.NDArray[np.int8]
    """+1 where the ground is raised, -1 where it is lowered, 0 elsewhere, shape [nrows, ncols]."""
    dirty: Rect | None
    """What changed since the preview before: first row, first column, end row, end column.

    None for nothing.
    """
    revision: int
    """Counts the previews; equal numbers mean equal ground."""


class EditDocument:
    """Mirror of the service's edit list, with an edit in progress: a new one on top, or one in its place.

    Attributes:
        revision: revision of the service's list.
        edits: the service's list, in order.
        undone: edits that redoing would bring back, the next one first.
        can_undo: whether the service has something to undo.
        can_redo: whether it has something to redo.
    """

    def __init__(self, grid: GridGeometry, z_b_base: npt.NDArray[np.float32]) -> None:
        """Begin with the base bed and no edit.

        Args:
            grid: geometry of the raster.
            z_b_base: the case's bed before any edit [m, datum-relative], shape [nrows, ncols].
        """
        self._grid = grid
        self._base = np.ascontiguousarray(z_b_base, dtype=np.float32)
        self._committed = self._base
        self._stale: Rect | None = None
        self._draft: Edit | None = None
        self._draft_dirty: Rect | None = None
        self._draft_changed = False
        self.revision = 0
        self.edits: tuple[Edit, ...] = ()
        self.undone: tuple[Edit, ...] = ()
        self.can_undo = False
        self.can_redo = False
        self._preview = EditPreview(self._base, np.zeros(self._base.shape, dtype=np.int8), None, 0)

    @property
    def base(self) -> npt.NDArray[np.float32]:
        """The bed before any edit [m]."""
        return self._base

    @property
    def bed(self) -> npt.NDArray[np.float32]:
        """The bed with the service's list on it [m]."""
        return self._committed

    @property
    def draft(self) -> Edit | None:
        """The edit being drawn, if any."""
        return self._draft

    def mirror(
        self,
        revision: int,
        edits: Sequence[Edit],
        can_undo: bool,
        can_redo: bool,
        undone: Sequence[Edit] = (),
    ) -> None:
        """Take over the list that the service reports.

        Raises:
            protocol.EditError: if an edit does not fit the terrain.
        """
        before, after = self.edits, tuple(edits)
        kept = set(before) & set(after)
        if [edit for edit in before if edit in kept] != [edit for edit in after if edit in kept]:
            kept = set()
        changed: Rect | None = None
        # Edits that stay in their order leave the ground as it is but under the others.
        for edit in (set(before) | set(after)) - kept:
            changed = union_rect(changed, self._covered(edit))
        if after != before:
            self._committed = self.bed_of(after)
        self.revision, self.edits, self.undone = revision, after, tuple(undone)
        self.can_undo, self.can_redo = can_undo, can_redo
        self._stale = union_rect(self._stale, changed)
        self._draft_changed = True

    def set_draft(self, edit: Edit | None) -> None:
        """Set, replace or (with None) drop the edit in progress.

        One that has the id of an edit of the list stands in the place of that edit.

        Raises:
            protocol.EditError: if it does not fit the terrain; nothing has changed then.
        """
        if edit == self._draft:
            return
        if edit is not None:
            self._covered(edit)
        self._draft, self._draft_changed = edit, True

    def edit(self, name: str) -> Edit:
        """The edit of an id in the service's list.

        Raises:
            protocol.EditError: there is none.
        """
        for edit in self.edits:
            if edit.id == name:
                return edit
        raise EditError(f"Edit {name!r} is not in the list; the id of one that is in it is allowed.")

    def ground(self, name: str | None = None) -> Callable[[float, float], float]:
        """The ground that an edit of the list changes, or that a new one would, as a function of x and y [m].

        Args:
            name: its id; None for a new edit at the end of the list.
        """
        before = self.edits
        if name is not None:
            before = before[: before.index(self.edit(name))]
        return Heightfield(self._grid, self.bed_of(before)).sample

    def bed_of(self, edits: Sequence[Edit]) -> npt.NDArray[np.float32]:
        """The bed of a run that was computed with a list of edits [m, datum-relative]."""
        return self._base if not edits else apply_edits(self._base, list(edits), self._grid).z_b

    def preview(self) -> EditPreview:
        """The ground with the service's edits and the draft; the same object while nothing changed.

        Raises:
            protocol.EditError: if the draft does not fit the terrain.
        """
        if self._stale is None and not self._draft_changed:
            return self._preview
        z_b, draft_dirty = self._committed, None
        if self._draft is not None:
            z_b, draft_dirty = self._drafted(self._draft)
        dirty = union_rect(self._stale, union_rect(self._draft_dirty, draft_dirty))
        self._stale, self._draft_dirty, self._draft_changed = None, draft_dirty, False
        if dirty is None:
            return self._preview
        sign = self._preview.sign.copy()
        window = (slice(dirty[0], dirty[2]), slice(dirty[1], dirty[3]))
        sign[window] = np.sign(z_b[window] - self._base[window]).astype(np.int8)
        self._preview = EditPreview(z_b, sign, dirty, self._preview.revision + 1)
        return self._preview

    def _drafted(self, draft: Edit) -> tuple[npt.NDArray[np.float32], Rect | None]:
        """The ground with the edit in progress, and where it differs from that of the list."""
        place = next((at for at, edit in enumerate(self.edits) if edit.id == draft.id), None)
        if place is None:
            return apply_edits(self._committed, [draft], self._grid).z_b, self._covered(draft)
        edits = (*self.edits[:place], draft, *self.edits[place + 1 :])
        return self.bed_of(edits), union_rect(self._covered(self.edits[place]), self._covered(draft))

    def _covered(self, edit: Edit) -> Rect | None:
        """The rectangle that holds the cells of an edit."""
        rows, cols, _ = rasterise_edit(edit, self._grid)
        if not rows.size:
            return None
        return int(rows[0]), int(cols.min()), int(rows[-1]) + 1, int(cols.max()) + 1
