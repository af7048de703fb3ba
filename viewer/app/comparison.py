"""The difference between the run on the picture and another one at the same time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import protocol
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.app.water_feed import WaterFeed
from viewer.commands import CommandError
from viewer.net import FrameKey, FrameLoader
from viewer.render import DepthDifference
from viewer.view_status import time_text

__all__ = ["Comparison"]

AT_REST = ("paused", "finished", "stopped", "failed")
"""States of a run in which the stream may be lent to another one."""


class Comparison:
    """Compares the shown run with another run on the same terrain.

    Args:
        desk: the dealings with the service.
        loader: where frames lie and are decoded.
        feed: the water on the picture; it is told which frames of the other run are wanted too.
        take_back: lets the stream serve the shown run again.

    Attributes:
        other: the other run; None compares with nothing.
        difference: what the picture shows of it; None when both runs share the frame, or it is not here yet.
    """

    def __init__(
        self, desk: ServiceDesk, loader: FrameLoader, feed: WaterFeed, take_back: Callable[[], None]
    ) -> None:
        self.other: ShownRun | None = None
        self.difference: DepthDifference | None = None
        self._desk = desk
        self._loader = loader
        self._feed = feed
        self._take_back = take_back
        self._has_stream = False

    def begin(self, shown: ShownRun, run: str | None) -> None:
        """Compare with a run; None compares with nothing.

        Raises:
            CommandError: the run is unknown, on the picture itself, or has another terrain.
        """
        self.end()
        if run is None:
            return
        info = self._desk.book.runs.get(run)
        if info is None:
            raise CommandError(f"run {run!r} is unknown")
        if run == shown.run:
            raise CommandError("a run cannot be compared with itself; choose another one")
        if info.grid.geometry != shown.grid or info.output_interval != shown.info.output_interval:
            raise CommandError(f"run {run!r} has another terrain or output interval; it cannot be compared")
        self.other = ShownRun(info, shown.document.base, self._loader, shown.heightfield)

    def end(self) -> None:
        """Compare with nothing."""
        self.return_stream()
        self.other = self.difference = None
        self._feed.also_wanted = ()

    def return_stream(self) -> None:
        """Let the stream serve the shown run again, if it was lent."""
        if self._has_stream:
            self._has_stream = False
            self._take_back()

    def take_frame(self, frame: protocol.Frame) -> None:
        """Note a frame that came in."""
        other = self.other
        if other is None or not other.note_frame((frame.run, frame.index)):
            return
        if other.next_missing() >= other.info.frame_count:
            self.return_stream()

    def advance(self, shown: ShownRun) -> bool:
        """Follow the water on the picture; return whether the difference has changed."""
        before = self.difference
        if self.other is not None and (self.other.run == shown.run or self.other.grid != shown.grid):
            self.end()
        self.difference = None if self.other is None else self._difference(shown, self.other)
        return self.difference is not before

    def _difference(self, shown: ShownRun, other: ShownRun) -> DepthDifference | None:
        pair, keys = self._feed.pair, self._feed.keys
        if pair is None or keys is None:
            return None
        other.info = self._desk.book.runs.get(other.run, other.info)
        nearer = 1 if pair.alpha > 0.5 else 0
        ours = keys[nearer]
        theirs = other.frame_key(ours[1])
        if theirs == ours:
            return None
        self._feed.also_wanted = (theirs,)
        water = self._loader.get(theirs)
        if water is None:
            self._fetch_missing(shown, other, theirs)
            return self.difference
        if self.difference is not None and self.difference.key == (ours, theirs):
            return self.difference
        h = (pair.second if nearer else pair.first).h
        return DepthDifference((ours, theirs), np.asarray(h - water.h, np.float32), _name(other))

    def _fetch_missing(self, shown: ShownRun, other: ShownRun, key: FrameKey) -> None:
        """Let the stream bring the other run while the shown one has nothing more to send."""
        has_all = len(shown.timeline) >= shown.info.frame_count
        if self._has_stream or self._loader.has(key) or not has_all or shown.info.status not in AT_REST:
            return
        missing = other.next_missing()
        if missing < other.info.frame_count:
            self._has_stream = True
            self._desk.subscribe(other.run, missing, "replay")


def _name(other: ShownRun) -> str:
    if other.branch_index:
        return f"branch from {time_text(other.branch_index * other.info.output_interval)}"
    return f"run {other.info.case}"
