"""Channels from packed bytes to fields, away from the thread that draws.

A daemon thread unpacks what has come, the newest first; fields stay ready within a byte budget.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import protocol

__all__ = ["ChannelFields", "ChannelKey", "ChannelLoader"]

ChannelKey = tuple[str, int, str]
"""Id of the run that holds a frame, the frame's index, and the name of the channel."""

FIELD_BYTES = 384 << 20
WAITING_MOST = 4
"""Packed channels that may wait; beyond that the oldest is forgotten, for something newer is wanted."""
FAST_SHARE = 90.0
"""This percentile of the speeds of moving water is the speed that arrows are scaled by."""
MOVING_M_S = 0.01
NOWHERE = np.float32(-1.0)
"""What a field of maxima holds where water never came."""


@dataclass(frozen=True)
class ChannelFields:
    """An unpacked channel.

    Attributes:
        key: names what was asked for.
        index: frame it is of; for maxima it may lie before the one asked for.
        time: simulated time [s].
        fields: float32 [nrows, ncols]: `u`, `v`, `speed` [m/s]; or `max_depth` [m], `max_speed` [m/s],
            `max_hazard` and `arrival` [s], negative where water never came.
        fast: speed that only `FAST_SHARE` of the moving water falls short of [m/s]; 0 for maxima.
    """

    key: ChannelKey
    index: int
    time: float
    fields: Mapping[str, npt.NDArray[np.float32]]
    fast: float = 0.0


class ChannelLoader:
    """Unpacks and keeps channels.

    Args:
        woken: called from the unpacking thread after something is ready.
        byte_budget: bytes of fields that may be kept.
    """

    def __init__(self, woken: Callable[[], None] | None = None, byte_budget: int = FIELD_BYTES) -> None:
        self._woken = woken
        self._budget = byte_budget
        self._waiting: OrderedDict[ChannelKey, tuple[protocol.Channel, protocol.BlockLayout]] = OrderedDict()
        self._ready: OrderedDict[ChannelKey, ChannelFields] = OrderedDict()
        self._broken: dict[ChannelKey, str] = {}
        self._cell: tuple[int, int] | None = None
        self._traced: dict[ChannelKey, tuple[float, float]] = {}
        self._stopped = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._unpack_waiting, name="fev-channel-loader", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread. May be called twice."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()
        self._thread.join()

    def store(self, key: ChannelKey, packed: protocol.Channel, layout: protocol.BlockLayout) -> None:
        """Unpack a channel soon; of too many that wait the oldest are forgotten."""
        with self._changed:
            self._waiting[key] = (packed, layout)
            self._waiting.move_to_end(key)
            while len(self._waiting) > WAITING_MOST:
                self._waiting.popitem(last=False)
            self._changed.notify_all()

    def get(self, key: ChannelKey) -> ChannelFields | None:
        """Return a channel if it is ready."""
        with self._changed:
            fields = self._ready.get(key)
            if fields is not None:
                self._ready.move_to_end(key)
            return fields

    def has(self, key: ChannelKey) -> bool:
        """Whether a channel is ready or waits to be unpacked."""
        with self._changed:
            return key in self._ready or key in self._waiting

    def ready(self, channel: str) -> list[ChannelKey]:
        """Return what is ready of a channel."""
        with self._changed:
            return [key for key in self._ready if key[2] == channel]

    def broken(self, key: ChannelKey) -> str | None:
        """Return why a channel cannot be unpacked, None when nothing is known against it."""
        with self._changed:
            return self._broken.get(key)

    def trace(self, row: int, col: int) -> None:
        """Note the speed of one cell in every velocity that is ready or comes."""
        with self._changed:
            if (row, col) != self._cell:
                self._cell = (row, col)
                self._traced = {}
                for fields in self._ready.values():
                    self._note_traced(fields)

    def traced(self) -> dict[ChannelKey, tuple[float, float]]:
        """Return time [s] and speed [m/s] of the traced cell in each velocity seen so far."""
        with self._changed:
            return dict(self._traced)

    def _unpack_waiting(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._stopped or bool(self._waiting))
                if self._stopped:
                    return
                key, (packed, layout) = next(reversed(self._waiting.items()))
            try:
                fields: ChannelFields | str = _unpacked(key, protocol.decode_channel(layout, packed))
            except protocol.ProtocolError as error:
                fields = str(error)
            with self._changed:
                self._waiting.pop(key, None)
                if isinstance(fields, str):
                    self._broken[key] = fields
                else:
                    self._keep(fields)
            if self._woken is not None:
                self._woken()

    def _keep(self, fields: ChannelFields) -> None:
        self._note_traced(fields)
        self._ready[fields.key] = fields
        self._ready.move_to_end(fields.key)
        each = sum(field.nbytes for field in fields.fields.values())
        # Two frames are drawn at a time, of two runs when they are compared.
        while len(self._ready) > max(4, self._budget // max(each, 1)):
            self._ready.popitem(last=False)

    def _note_traced(self, fields: ChannelFields) -> None:
        speed = fields.fields.get("speed")
        if speed is not None and self._cell is not None and self._cell < speed.shape:
            self._traced[fields.key] = (fields.time, float(speed[self._cell]))


def _unpacked(key: ChannelKey, decoded: protocol.DecodedChannel) -> ChannelFields:
    given = decoded.fields
    if decoded.channel == "velocity":
        speed = np.hypot(given["u"], given["v"])
        moving = speed[speed > MOVING_M_S]
        fast = float(np.percentile(moving, FAST_SHARE)) if moving.size else 0.0
        fields = {"u": given["u"], "v": given["v"], "speed": speed}
        return ChannelFields(key, decoded.index, decoded.time, fields, fast)
    never = given["max_depth"] <= 0.0
    fields = {
        name: np.where(never, NOWHERE, given[name]) for name in ("max_depth", "max_speed", "max_hazard")
    }
    arrival = given["arrival_time"]
    fields["arrival"] = np.where(np.isfinite(arrival), arrival, NOWHERE)
    return ChannelFields(key, decoded.index, decoded.time, fields)
