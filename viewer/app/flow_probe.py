"""Speed and direction of the water at a point, now and in as many frames as velocity has come of."""

from __future__ import annotations

import math
import time as wall_clock

from viewer.app.channel_feed import ChannelFeed
from viewer.app.shown_run import ShownRun
from viewer.app.water_feed import WaterFeed
from viewer.net import ChannelKey

__all__ = ["FlowProbe", "Record"]

Record = tuple[tuple[float, ...], tuple[float, ...]]
"""Times [s] and values."""

RECORD_POINTS = 48
"""So many frames of a run, at most, have their velocity fetched for the record of a point."""
FETCH_PAUSE_S = 0.1
"""Least wall time between two of these requests: they must not hinder those of the picture."""


class FlowProbe:
    """Reads velocity at points.

    Args:
        channels: where velocity comes from.
        feed: the water on the picture.
    """

    def __init__(self, channels: ChannelFeed, feed: WaterFeed) -> None:
        self._channels = channels
        self._feed = feed
        self._asked = -math.inf

    def at(self, shown: ShownRun, x: float, y: float) -> tuple[float, float | None] | None:
        """Return speed [m/s] and compass bearing [deg] of the water on the picture at (x, y) [m].

        The speed is blended between the frames as the colours are; the bearing is None in still water. All is
        None where velocity is not at hand, or outside the terrain.
        """
        keys, pair = self._feed.keys, self._feed.pair
        row, col = (math.floor(place + 0.5) for place in shown.grid.to_cell(x, y))
        if keys is None or pair is None or not (0 <= row < shown.grid.nrows and 0 <= col < shown.grid.ncols):
            return None
        east = north = speed = 0.0
        for key, share in zip(keys, (1.0 - pair.alpha, pair.alpha), strict=True):
            velocity = self._channels.get((*key, "velocity"))
            if velocity is None:
                return None
            east += share * float(velocity.fields["u"][row, col])
            north += share * float(velocity.fields["v"][row, col])
            speed += share * float(velocity.fields["speed"][row, col])
        bearing = math.degrees(math.atan2(east, north)) % 360.0 if math.hypot(east, north) > 1e-6 else None
        return speed, bearing

    def follow(self, runs: tuple[ShownRun, ...], at: tuple[float, float]) -> None:
        """Let velocity come: first that of the picture, then, while nothing else comes, that of the record.

        Args:
            runs: the run on the picture, and the one it is compared with.
            at: the point (x, y) [m].
        """
        shown = runs[0]
        row, col = (math.floor(place + 0.5) for place in shown.grid.to_cell(*at))
        self._channels.loader.trace(row, col)
        if self._feed.keys is not None:
            self._channels.want([(*key, "velocity") for key in self._feed.keys])
        now = wall_clock.monotonic()
        if not self._channels.is_idle or now - self._asked < FETCH_PAUSE_S:
            return
        known = self._channels.loader.traced()
        for run in runs:
            missing = [key for key in self._record_keys(run) if key not in known]
            if missing:
                self._asked = now
                self._channels.want(missing[:1])
                return

    def record(self, run: ShownRun) -> Record:
        """Return times [s] and speeds [m/s] at the point that is followed, as far as velocity has come."""
        traced = self._channels.loader.traced()
        read = sorted(at for key, at in traced.items() if run.frame_key(key[1]) == key[:2])
        return tuple(time for time, _ in read), tuple(speed for _, speed in read)

    def _record_keys(self, run: ShownRun) -> list[ChannelKey]:
        if "velocity" not in run.info.channels:
            return []
        indices = run.timeline.indices
        step = max(1, -(-len(indices) // RECORD_POINTS))
        return [(*run.frame_key(index), "velocity") for index in indices[::step]]
