"""The two frames round the playback time, as soon as they are decoded."""

from __future__ import annotations

import time as wall_clock
from collections import OrderedDict
from collections.abc import Callable, Hashable

import numpy as np
import numpy.typing as npt

import protocol
from viewer.app.run_book import RunBook
from viewer.app.shown_run import ShownRun
from viewer.net import DecodedWater, FrameKey, FrameLoader
from viewer.render import WaterFrame, WaterPair
from viewer.world import MovedBed, bed_with, blended_bed

__all__ = ["WaterFeed"]

AHEAD = 3
"""Frames decoded ahead of the playback time."""
MOVED_BEDS_KEPT = 4
REQUEST_PAUSE_S = 1.0
"""Wall time before a missing frame is asked for once more."""


class WaterFeed:
    """Turns the playback time into the water to draw.

    Args:
        loader: where frames lie and are decoded.
        book: knows the edits below the water of each run.
        request: asks the service for frame `index` of the run.
        main: the feed that the loader listens to, when this one stands beside it; None for the main one.

    Attributes:
        pair: the water on the picture, None before the first frame.
        keys: the frames of `pair`.
        moved: what breaches have moved of the bed between the frames of `pair`; None for nothing.
        also_wanted: frames that something else needs at the same time.
    """

    def __init__(
        self,
        loader: FrameLoader,
        book: RunBook,
        request: Callable[[int], None],
        main: WaterFeed | None = None,
    ) -> None:
        self._loader = loader
        self._book = book
        self._request = request
        self._main = main
        self._requested: dict[int, float] = {}
        self._beds: dict[Hashable, npt.NDArray[np.float32]] = {}
        self._moved: OrderedDict[Hashable, tuple[MovedBed, npt.NDArray[np.float32]]] = OrderedDict()
        self.pair: WaterPair | None = None
        self.keys: tuple[FrameKey, FrameKey] | None = None
        self.moved: MovedBed | None = None
        self.also_wanted: tuple[FrameKey, ...] = ()

    def forget(self) -> None:
        """Show no water: another terrain is shown."""
        self.pair = None
        self.keys = None
        self.moved = None
        self._requested.clear()
        self._moved.clear()
        self._beds.clear()

    def wanted(self, shown: ShownRun, time: float) -> tuple[list[FrameKey], float]:
        """Return the frames wanted round `time` [s], the first two to be drawn, and where between them."""
        bracket = shown.timeline.bracket(time)
        if bracket is None:
            return [], 0.0
        indices = [bracket.first, bracket.second]
        indices += [index for index in range(bracket.second + 1, bracket.second + 1 + AHEAD)]
        keys = [shown.frame_key(index) for index in indices]
        return keys[:2] + [key for key in keys[2:] if self._loader.has(key)], bracket.alpha

    def advance(self, shown: ShownRun, time: float) -> bool:
        """Move to playback time `time` [s]; return whether the water on the picture has changed."""
        self._request_missing(shown, time)
        keys, alpha = self.wanted(shown, time)
        if not keys:
            return False
        if self._main is None:
            self._loader.want(list(dict.fromkeys([*keys[:2], *self.also_wanted, *keys[2:]])))
        else:
            self._main.also_wanted = tuple(keys)
        first, second = self._loader.get(keys[0]), self._loader.get(keys[1])
        if first is None or second is None:
            return False
        drawn = (keys[0], keys[1])
        if self.pair is not None and drawn == self.keys and alpha == self.pair.alpha:
            return False
        self.keys = drawn
        (before, moved_before), (after, moved_after) = self._frame(shown, first), self._frame(shown, second)
        self.pair = WaterPair(before, after, alpha)
        self.moved = blended_bed(moved_before, moved_after, alpha)
        return True

    def depths(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], float] | None:
        """Return the two depth arrays on the picture [m] and where between them it stands."""
        if self.pair is None:
            return None
        return self.pair.first.h, self.pair.second.h, self.pair.alpha

    def _frame(self, shown: ShownRun, water: DecodedWater) -> tuple[WaterFrame, MovedBed | None]:
        edits = self._book.edits_below(water.run, water.revision)
        bed, moved = self._bed(shown, edits), None
        if water.bed_cells.size:
            bed, moved = self._moved_bed(bed, water)
        return WaterFrame((water.run, water.index), water.h, water.states, bed), moved

    def _moved_bed(
        self, bed: npt.NDArray[np.float32], water: DecodedWater
    ) -> tuple[npt.NDArray[np.float32], MovedBed]:
        """Return the bed with what breaches have moved; the same objects while it moves no further."""
        name = (id(bed), water.bed_cells.tobytes(), water.bed_values.tobytes())
        if name not in self._moved:
            moved = MovedBed(water.bed_cells, water.bed_values, bed.ravel()[water.bed_cells])
            self._moved[name] = (moved, bed_with(bed, moved))
            while len(self._moved) > MOVED_BEDS_KEPT:
                self._moved.popitem(last=False)
        self._moved.move_to_end(name)
        moved, laid = self._moved[name]
        return laid, moved

    def _bed(self, shown: ShownRun, edits: tuple[protocol.Edit, ...]) -> npt.NDArray[np.float32]:
        name = (shown.root, tuple(edit.id for edit in edits))
        bed = self._beds.get(name)
        if bed is None:
            bed = self._beds[name] = shown.document.bed_of(edits)
        return bed

    def _request_missing(self, shown: ShownRun, time: float) -> None:
        """Ask for the frame at `time` when it is computed but not at hand, and for a lost key frame."""
        newest = shown.info.frame_count - 1
        index = min(shown.timeline.index_before(time), newest)
        if index < 0:
            return
        for wanted in (index, min(index + 1, newest)):
            missing = self._loader.missing_for(shown.frame_key(wanted))
            if missing is None:
                continue
            now = wall_clock.monotonic()
            if now - self._requested.get(missing, -REQUEST_PAUSE_S) >= REQUEST_PAUSE_S:
                self._requested[missing] = now
                self._request(missing)
            return
