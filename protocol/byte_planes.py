"""A lossless order of 16-bit numbers that zstd packs well.

Neighbours are alike, so each number becomes its difference to the one before, with the sign in the lowest
bit (zigzag), so that small differences have a high byte of 0. All low bytes come first, then all high bytes.
"""

from __future__ import annotations

import numpy as np

from protocol.blocks import UInt8Array, UInt16Array


def to_planes(numbers: UInt16Array) -> UInt8Array:
    """The planes of n numbers, uint8 [2 n]; signed numbers go as their uint16 pattern."""
    differences = np.diff(numbers, prepend=np.uint16(0))
    zigzag = (differences << np.uint16(1)) ^ (differences.view(np.int16) >> 15).view(np.uint16)
    planes = np.empty((2, numbers.size), np.uint8)
    planes[0] = zigzag  # the cast keeps the low byte
    planes[1] = zigzag >> np.uint16(8)
    return planes.reshape(-1)


def from_planes(planes: UInt8Array) -> UInt16Array:
    """The numbers of planes of an even number of bytes."""
    low, high = planes.reshape(2, -1)
    zigzag = high.astype(np.uint16)
    zigzag <<= np.uint16(8)
    zigzag |= low
    differences = (zigzag >> np.uint16(1)) ^ (np.uint16(0) - (zigzag & np.uint16(1)))
    return np.cumsum(differences, dtype=np.uint16)
