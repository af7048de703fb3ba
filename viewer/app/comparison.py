"""The run on the picture against another one at the same time: by difference, or side by side."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np

import protocol
from viewer.app.channel_feed import ChannelFeed
from viewer.app.other_run import OtherRun
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.app.water_feed import WaterFeed
from viewer.commands import Command, CommandError, CompareWith, MoveSwipe
from viewer.net import FrameKey, FrameLoader
from viewer.render import Beside, DepthDifference, FrameInputs, RenderOptions
from viewer.view_status import ViewStatus, time_text

__all__ = ["Comparison"]

AT_REST = ("paused", "finished", "stopped", "failed")
"""States of a run in which the stream may be lent to another one."""


MODES = ("difference", "swipe")
SWIPE_RANGE = (0.03, 0.97)
"""The divider stays so far from the sides, as a share of the width."""


class Comparison:
    """Compares the shown run with another run on the same terrain.

    Args:
        desk: the dealings with the service.
        loader: where frames lie and are decoded.
        feed: the water on the picture; it is told which frames of the other run are wanted too.
        channels: where velocity and maxima come from.
        take_back: lets the stream serve the shown run again.

    Attributes:
        other: the other run; None compares with nothing.
        difference: what the picture shows of it; None when both runs share the frame, or it is not here yet.
        beside: what is drawn of the other run right of the divider; None without a divider.
        swipe_at: where the divider stands, as a share of the picture's width.
    """

    def __init__(
        self,
        desk: ServiceDesk,
        loader: FrameLoader,
        feed: WaterFeed,
        channels: ChannelFeed,
        take_back: Callable[[], None],
    ) -> None:
        self.beside: OtherRun | None = None
        self.swipe_at = 0.5
        self._channels = channels
        self._is_moved = False
        self.other: ShownRun | None = None
        self.difference: DepthDifference | None = None
        self._desk = desk
        self._loader = loader
        self._feed = feed
        self._take_back = take_back
        self._has_stream = False
        self._shown: ShownRun | None = None

    def carry_out(self, command: Command, shown: ShownRun | None) -> bool:
        """Carry out a command of comparing; return whether it was one.

        Raises:
            CommandError: as for `begin`; or the divider is to stand at what is no share.
        """
        if isinstance(command, MoveSwipe):
            if not math.isfinite(command.at):
                raise CommandError(f"MoveSwipe.at = {command.at!r} is not allowed; it must be from 0 to 1")
            self.swipe_at = min(max(command.at, SWIPE_RANGE[0]), SWIPE_RANGE[1])
            self._is_moved = True
            return True
        if not isinstance(command, CompareWith):
            return False
        if shown is None:
            raise CommandError("no run is shown yet")
        self.begin(shown, command.run, command.mode)
        self._is_moved = True
        return True

    def begin(self, shown: ShownRun, run: str | None, mode: str = "difference") -> None:
        """Compare with a run; None compares with nothing.

        Raises:
            CommandError: mode or run are unknown, or the run is on the picture or has another terrain.
        """
        if mode not in MODES:
            raise CommandError(f"CompareWith.mode = {mode!r} is unknown; known are {', '.join(MODES)}")
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
        if mode == "swipe":
            book = self._desk.book
            self.beside = OtherRun(shown, run, self._loader, book, self._feed, self._channels, self._request)
            self.other = self.beside.run
        else:
            self.other = ShownRun(info, shown.document.base, self._loader, shown.heightfield)

    def end(self) -> None:
        """Compare with nothing."""
        self.return_stream()
        self.other = self.difference = self.beside = None
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

    def advance(self, shown: ShownRun, time: float, options: RenderOptions) -> bool:
        """Follow the water on the picture; return whether the comparison has changed.

        Args:
            shown: the run on the picture.
            time: playback time [s].
            options: what the user wants of the picture.
        """
        before = self.difference
        changed, self._is_moved = self._is_moved, False
        if self.other is not None and (self.other.run == shown.run or self.other.grid != shown.grid):
            self.end()
        if self.beside is not None:
            self._shown = shown
            return self.beside.advance(time, options) or changed
        self.difference = None if self.other is None else self._difference(shown, self.other)
        return self.difference is not before or changed

    def dressed(self, inputs: FrameInputs, shown: ShownRun) -> FrameInputs:
        """Return the inputs of a picture with the comparison."""
        if self.beside is None:
            return dataclasses.replace(inputs, difference=self.difference)
        theirs = self.beside.inputs(inputs.camera, inputs.options, inputs.is_outdated)
        right = self.beside.run
        pair = Beside(self.swipe_at, right.heightfield, theirs, _name(shown), _name(right))
        return dataclasses.replace(inputs, beside=pair)

    def told(self, status: ViewStatus) -> ViewStatus:
        """Return `status` with what is compared."""
        return dataclasses.replace(
            status,
            compared_run=None if self.other is None else self.other.run,
            compare_mode="difference" if self.beside is None else "swipe",
            swipe_at=None if self.beside is None else self.swipe_at,
        )

    def _request(self, index: int) -> None:
        """Let a frame of the other run come."""
        if self.other is not None and self._shown is not None:
            self._fetch_missing(self._shown, self.other, self.other.frame_key(index))

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
