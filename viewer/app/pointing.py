"""The point under the pointer and the probed point: what water and ground are there."""

from __future__ import annotations

import dataclasses
import math

from viewer.app.shown_run import ShownRun
from viewer.app.status_report import depth_record, point_readout
from viewer.app.water_feed import WaterFeed
from viewer.commands import MoveHover, ProbeAt
from viewer.net import FrameLoader
from viewer.view_status import PointReadout, ViewStatus

__all__ = ["Pointing"]


class Pointing:
    """Knows which two points of the map are asked for.

    Args:
        loader: reads the depth at the probed point from every frame at hand.
        feed: the water on the picture.
    """

    def __init__(self, loader: FrameLoader, feed: WaterFeed) -> None:
        self._loader = loader
        self._feed = feed
        self.hover_at: tuple[float, float] | None = None
        self.probe_at: tuple[float, float] | None = None

    def take(self, command: MoveHover | ProbeAt, shown: ShownRun | None) -> None:
        """Follow the pointer, or keep another point."""
        if isinstance(command, ProbeAt):
            self.probe_at = (command.x, command.y)
            self.trace(shown)
        elif command.x is None or command.y is None:
            self.hover_at = None
        else:
            self.hover_at = (command.x, command.y)

    def trace(self, shown: ShownRun | None) -> None:
        """Let the depth at the probed point be read from every frame at hand."""
        if shown is None or self.probe_at is None:
            return
        row, col = (math.floor(at + 0.5) for at in shown.grid.to_cell(*self.probe_at))
        if 0 <= row < shown.grid.nrows and 0 <= col < shown.grid.ncols:
            self._loader.trace(row, col, [shown.frame_key(index) for index in shown.timeline.indices])

    def readout(self, x: float, y: float, shown: ShownRun | None) -> PointReadout | None:
        """Return water and ground at (x, y) [m], None outside the terrain."""
        return None if shown is None else point_readout(shown, self._feed, (x, y))

    def report(self, status: ViewStatus, shown: ShownRun) -> ViewStatus:
        """Return `status` with what is known of the two points."""
        return dataclasses.replace(
            status,
            hover=point_readout(shown, self._feed, self.hover_at),
            probe=point_readout(shown, self._feed, self.probe_at),
            depth_record=((), ()) if self.probe_at is None else depth_record(shown, self._loader),
        )
