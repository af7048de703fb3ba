"""Which channels a run keeps, and with which frames.

Velocity goes with every frame. Maxima change slowly and cost twice as much, so they go with every fourth
index, and with the first and the last frame that a run computes itself.
"""

from __future__ import annotations

from collections.abc import Iterable

from protocol import CHANNEL_NAMES, ChannelName

MAXIMA_EVERY = 4


def kept_channels(names: Iterable[str]) -> tuple[ChannelName, ...]:
    """The channels of these names, each once, in the order in which they are always told."""
    wanted = set(names)
    return tuple(name for name in CHANNEL_NAMES if name in wanted)


def due_channels(
    kept: tuple[ChannelName, ...], index: int, first_index: int, last_index: int
) -> tuple[ChannelName, ...]:
    """The channels that go with a frame.

    Args:
        kept: what the run keeps.
        index: frame index.
        first_index: first frame that the run computes itself.
        last_index: its last frame.
    """
    with_maxima = index % MAXIMA_EVERY == 0 or index in (first_index, last_index)
    return tuple(name for name in kept if name != "maxima" or with_maxima)
