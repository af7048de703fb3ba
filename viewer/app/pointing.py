"""The point under the pointer and the probed point: what water and ground are there."""

from __future__ import annotations

import dataclasses
import math

from viewer.app.flow_probe import FlowProbe, Record
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
        flow: reads velocity.
    """

    def __init__(self, loader: FrameLoader, feed: WaterFeed, flow: FlowProbe) -> None:
        self._loader = loader
        self._flow = flow
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

    def trace(self, shown: ShownRun | None, other: ShownRun | None = None) -> None:
        """Let the depth at the probed point be read from every frame at hand, and velocity as it comes.

        Args:
            shown: the run on the picture.
            other: the run that it is compared with.
        """
        if shown is None or self.probe_at is None:
            return
        row, col = (math.floor(at + 0.5) for at in shown.grid.to_cell(*self.probe_at))
        if 0 <= row < shown.grid.nrows and 0 <= col < shown.grid.ncols:
            runs = (shown,) if other is None else (shown, other)
            keys = [run.frame_key(index) for run in runs for index in run.timeline.indices]
            self._loader.trace(row, col, list(dict.fromkeys(keys)))
            self._flow.follow(runs, self.probe_at)

    def readout(self, x: float, y: float, shown: ShownRun | None) -> PointReadout | None:
        """Return water and ground at (x, y) [m], None outside the terrain."""
        plain = None if shown is None else point_readout(shown, self._feed, (x, y))
        flow = None if shown is None or plain is None else self._flow.at(shown, x, y)
        if plain is None or flow is None or plain.level is None:
            return plain
        return dataclasses.replace(plain, speed=flow[0], bearing=flow[1])

    def report(self, status: ViewStatus, shown: ShownRun, other: ShownRun | None = None) -> ViewStatus:
        """Return `status` with what is known of the two points; `other` is compared with."""
        hover = None if self.hover_at is None else self.readout(*self.hover_at, shown)
        if self.probe_at is None:
            return dataclasses.replace(status, hover=hover)
        nothing: Record = ((), ())
        return dataclasses.replace(
            status,
            hover=hover,
            probe=self.readout(*self.probe_at, shown),
            depth_record=depth_record(shown, self._loader),
            speed_record=self._flow.record(shown),
            other_depth_record=nothing if other is None else depth_record(other, self._loader),
            other_speed_record=nothing if other is None else self._flow.record(other),
        )
