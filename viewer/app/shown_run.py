"""The run on the picture: its ground, its edits, and which of its frames are at hand.

Frames belong to the run that computed them. A branch shares its past with its ancestors, so a frame index is
looked up in the lineage: the youngest run whose frames begin at or before it.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

import protocol
from viewer.net import FrameKey, FrameLoader
from viewer.world import EditDocument, Heightfield, MovedBed, Rect, WaterTimeline, union_rect

__all__ = ["ShownRun"]

_SERIAL = itertools.count(1)
FOREIGN = -2
"""Revision of a ground that no preview of this run has made."""


class ShownRun:
    """A run whose terrain is known.

    Args:
        info: the run.
        z_b_base: its bed before any edit [m, datum-relative], shape [nrows, ncols].
        loader: where its frames lie.
        heightfield: ground of another run on the same terrain to go on with; None makes one of the base bed.

    Attributes:
        info: the run as the service described it last.
        heightfield: the ground as drawn: base, working list and the line being drawn.
        document: the working list of edits.
        timeline: frames at hand, ancestors' included.
    """

    def __init__(
        self,
        info: protocol.RunInfo,
        z_b_base: npt.NDArray[np.float32],
        loader: FrameLoader,
        heightfield: Heightfield | None = None,
    ) -> None:
        self.info = info
        self.grid = info.grid.geometry
        self._serial = next(_SERIAL)
        self._drawn_revision = 0 if heightfield is None else FOREIGN
        self._moved: MovedBed | None = None
        self.heightfield = Heightfield(self.grid, z_b_base) if heightfield is None else heightfield
        self.document = EditDocument(self.grid, z_b_base)
        self.timeline = WaterTimeline(info.output_interval)
        self._loader = loader
        for entry in self.lineage:
            loader.add_run(entry.run, self.grid.nrows, self.grid.ncols)
        self.collect_frames()

    @property
    def run(self) -> str:
        """Its id."""
        return self.info.run

    @property
    def lineage(self) -> tuple[protocol.LineageEntry, ...]:
        """The runs that hold its frames, oldest first, itself last."""
        return self.info.lineage or (protocol.LineageEntry(self.info.run, 0),)

    @property
    def root(self) -> str:
        """Id of the run its lineage begins with; all of one root share their base bed."""
        return self.lineage[0].run

    @property
    def branch_index(self) -> int:
        """Frame index its own frames begin at; 0 for a run of its own."""
        return self.lineage[-1].first_index

    @property
    def computed_until(self) -> float:
        """Time of the newest computed frame [s]."""
        newest = max(self.info.frame_count - 1, self.branch_index, 0)
        return max(newest * self.info.output_interval, self.timeline.last_time)

    def frame_key(self, index: int) -> FrameKey:
        """Return which run holds frame `index`."""
        holder = self.lineage[0].run
        for entry in self.lineage:
            if entry.first_index <= index:
                holder = entry.run
        return (holder, index)

    def note_frame(self, key: FrameKey) -> bool:
        """Note that a frame has come; return whether it is one of this run's."""
        is_ours = self.frame_key(key[1]) == key
        if is_ours:
            self.timeline.add(key[1])
        return is_ours

    def discard_frames(self, run: str, indices: Iterable[int]) -> None:
        """Note that frames of `run` are no longer at hand."""
        for index in indices:
            if self.frame_key(index) == (run, index):
                self.timeline.discard(index)

    def collect_frames(self) -> None:
        """Note every frame of the lineage that is at hand already."""
        for entry in self.lineage:
            for index in self._loader.indices(entry.run):
                self.note_frame((entry.run, index))

    def next_missing(self, start: int = 0) -> int:
        """Return the first index from `start` on that is not at hand."""
        index = start
        while index in self.timeline:
            index += 1
        return index

    def refresh_ground(self, moved: MovedBed | None = None) -> bool:
        """Bring the heightfield up to date with the edits and breaches; return whether anything changed.

        Args:
            moved: what breaches have moved at the time shown; None for nothing.

        Raises:
            protocol.EditError: the line being drawn does not fit the terrain.
        """
        has_edited = self._refresh_edits()
        if moved is self._moved and not (has_edited and moved is not None):
            return has_edited
        self._lay(moved)
        return True

    def _lay(self, moved: MovedBed | None) -> None:
        """Put the bed of the edits where it had moved, and then lay what has moved now over it."""
        ncols = self.grid.ncols
        rects = [part.rect(ncols) for part in (self._moved, moved) if part is not None]
        self._moved = moved
        rect = union_rect(rects[0], rects[-1])
        if rect is None:
            return
        ground = self.document.preview().z_b
        part = ground[rect[0] : rect[2], rect[1] : rect[3]].copy()
        if moved is not None:
            rows, cols = np.divmod(moved.cells, ncols)
            part[rows - rect[0], cols - rect[1]] = moved.on(ground[rows, cols])
        self.heightfield.set_part(rect, part)

    def _refresh_edits(self) -> bool:
        preview = self.document.preview()
        if preview.revision == self._drawn_revision:
            return False
        # A preview knows what changed since the one before; if that was never drawn, only a look tells.
        is_next, self._drawn_revision = preview.revision == self._drawn_revision + 1, preview.revision
        dirty = preview.dirty if is_next else _difference(self.heightfield.z_b, preview.z_b)
        if dirty is None:
            return False
        self.heightfield.set(preview.z_b, dirty)
        return True

    def overlay_revision(self) -> int:
        """Return a number that changes with the edit marks, within this run and from run to run."""
        return self._serial * 1_000_000 + self.document.preview().revision


def _difference(before: npt.NDArray[np.float32], after: npt.NDArray[np.float32]) -> Rect | None:
    """Return the smallest rectangle that holds every cell in which two beds differ, None for equal ones."""
    differs = before != after
    rows, cols = np.flatnonzero(differs.any(axis=1)), np.flatnonzero(differs.any(axis=0))
    if rows.size == 0:
        return None
    return int(rows[0]), int(cols[0]), int(rows[-1]) + 1, int(cols[-1]) + 1
