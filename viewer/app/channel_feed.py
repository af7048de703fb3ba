"""Asks the service for the channels that the picture wants, the newest wish first."""

from __future__ import annotations

import time as wall_clock
from collections.abc import Sequence

import protocol
from viewer.app.service_desk import ServiceDesk
from viewer.net import ChannelFields, ChannelKey, ChannelLoader

__all__ = ["ChannelFeed"]

UNDER_WAY_MOST = 2
"""Requests that may be unanswered at a time: what was wished for longer ago is then not asked for at all."""
LOST_AFTER_S = 20.0
"""Wall time after which a request counts as lost, say with its connection."""
REFUSED_PAUSE_S = 2.0
"""Wall time before a channel that was refused is asked for again."""


class ChannelFeed:
    """Keeps channels coming.

    Args:
        desk: the dealings with the service.
        loader: unpacks and keeps them.

    Attributes:
        loader: unpacks and keeps them.
    """

    def __init__(self, desk: ServiceDesk, loader: ChannelLoader) -> None:
        self.loader = loader
        self._desk = desk
        self._under_way: dict[int, tuple[ChannelKey, float]] = {}
        self._refused: dict[ChannelKey, float] = {}
        desk.channel_came = self._take

    def keeps(self, run: str, channel: str) -> bool:
        """Whether a run keeps a channel, as far as the service has told."""
        info = self._desk.book.runs.get(run)
        return info is not None and channel in info.channels

    def want(self, keys: Sequence[ChannelKey]) -> None:
        """Say which channels are needed now, most urgent first; nothing waits for them."""
        if not self._desk.is_open:
            return
        now = wall_clock.monotonic()
        lost = [number for number, (_, since) in self._under_way.items() if now - since > LOST_AFTER_S]
        for number in lost:
            del self._under_way[number]
        for key in keys:
            if len(self._under_way) >= UNDER_WAY_MOST:
                return
            if self._is_missing(key, now) and self.keeps(key[0], key[2]):
                self._ask(key, now)

    def get(self, key: ChannelKey) -> ChannelFields | None:
        """Return a channel if it is ready."""
        return self.loader.get(key)

    @property
    def is_idle(self) -> bool:
        """Whether nothing is under way."""
        return not self._under_way

    def _is_missing(self, key: ChannelKey, now: float) -> bool:
        asked = any(key == at for at, _ in self._under_way.values())
        if asked or self.loader.has(key) or self.loader.broken(key) is not None:
            return False
        return now - self._refused.get(key, -REFUSED_PAUSE_S) >= REFUSED_PAUSE_S

    def _ask(self, key: ChannelKey, now: float) -> None:
        numbers: list[int] = []

        def refused(_reason: str) -> None:
            self._refused[key] = wall_clock.monotonic()
            for number in numbers:
                self._under_way.pop(number, None)

        run, index, channel = key
        sent = self._desk.fetch_channel(run, index, channel, numbers.append, refused)
        if sent:
            self._under_way[numbers[0]] = (key, now)

    def _take(self, message: protocol.ChannelReceived) -> None:
        key, _ = self._under_way.pop(message.id, (None, 0.0))
        info = None if key is None else self._desk.book.runs.get(key[0])
        if key is not None and info is not None:
            layout = protocol.BlockLayout(info.grid.nrows, info.grid.ncols)
            self.loader.store(key, message.channel, layout)
