"""Notes when and where water first stands on ground that an edit has raised."""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
import numpy as np

from protocol import Edit
from viewer.app.shown_run import ShownRun
from viewer.app.water_feed import WaterFeed
from viewer.net import FrameKey
from viewer.render import WaterFrame
from viewer.world import EditMeasure, measure_edits

__all__ = ["LeveeWatch", "Overtopping"]


@dataclass(frozen=True)
class Overtopping:
    """The first frame in which water stands on a raised edit: time [s], and the deepest place (x, y) [m]."""

    time: float
    x: float
    y: float


class LeveeWatch:
    """Looks at every frame that comes on the picture.

    A levee that is overtopped in frames that were never shown is not known of.
    """

    def __init__(self) -> None:
        self._first: dict[tuple[str, str], tuple[Edit, Overtopping]] = {}
        self._seen: set[tuple[FrameKey, str, int]] = set()
        self._measured: tuple[object, ...] | None = None
        self._measures: tuple[EditMeasure, ...] = ()

    def measures(self, shown: ShownRun) -> tuple[EditMeasure, ...]:
        """Return length, volume and cells of the edits of the working list."""
        document = shown.document
        state = (shown.root, document.edits)
        if state != self._measured:
            self._measured = state
            self._measures = measure_edits(document.base, document.edits, shown.grid)
        return self._measures

    def look(self, shown: ShownRun, feed: WaterFeed, depth_shown: float) -> bool:
        """Look at the frames on the picture; return whether an overtopping has become known.

        Args:
            shown: the run on the picture.
            feed: its water.
            depth_shown: water shallower than this does not count [m].
        """
        if feed.pair is None or feed.keys is None or not shown.document.edits:
            return False
        known = len(self._first)
        for key, frame in zip(feed.keys, (feed.pair.first, feed.pair.second), strict=True):
            look = (key, shown.run, shown.document.revision)
            if look not in self._seen:
                self._seen.add(look)
                self._look_at(shown, key, frame, depth_shown)
        return len(self._first) != known

    def overtopping(self, shown: ShownRun, edit: Edit) -> Overtopping | None:
        """Return when and where an edit was first seen overtopped in the shown run or its past.

        What was seen of it before it was moved or changed does not count.
        """
        known = (self._first.get((entry.run, edit.id)) for entry in shown.lineage)
        found = [first for first in known if first is not None and _is_same_ground(first[0], edit)]
        return min((at for _, at in found), key=lambda at: at.time, default=None)

    def _look_at(self, shown: ShownRun, key: FrameKey, frame: WaterFrame, depth_shown: float) -> None:
        run, index = key
        time = index * shown.info.output_interval
        for edit, measure in zip(shown.document.edits, self.measures(shown), strict=True):
            before = self._first.get((run, edit.id))
            if frame.z_b is None or not measure.rows.size:
                continue
            if before is not None and before[1].time <= time and _is_same_ground(before[0], edit):
                continue
            cells = (measure.rows, measure.cols)
            # The past of a branch has no levee yet, and the bed below a frame may have it as it was before.
            ground = frame.z_b[cells]
            stands = (ground > shown.document.base[cells]) & (ground == shown.document.bed[cells])
            h = np.where(stands, frame.h[cells], np.float32(0.0))
            deepest = int(np.argmax(h))
            if h[deepest] > depth_shown:
                x, y = shown.grid.center(int(measure.rows[deepest]), int(measure.cols[deepest]))
                self._first[(run, edit.id)] = (edit, Overtopping(time, x, y))


def _is_same_ground(first: Edit, second: Edit) -> bool:
    return first is second or msgspec.structs.replace(first, name=second.name) == second
