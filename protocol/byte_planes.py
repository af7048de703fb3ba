"""A lossless order of 16-bit numbers that zstd packs well.

Neighbours are alike, so each number becomes its difference to the one before, with the sign in the lowest
bit (zigzag), so that small differences have a high byte of 0. All low bytes come first, then all high bytes.
"""

from __future__ import annotations

import numpy as np

from protocol.blocks import UInt8Array, UInt16Array

_ONE, _EIGHT = np.uint16(1), np.uint16(8)


def to_planes(numbers: UInt16Array) -> UInt8Array:
    """The planes of n numbers, uint8 [2 n]; signed numbers go as their uint16 pattern."""
    zigzag = numbers.copy()
    zigzag[1:] -= numbers[:-1]
    signs = (zigzag.view(np.int16) >> np.int16(15)).view(np.uint16)
    zigzag <<= _ONE
    zigzag ^= signs
    planes = np.empty((2, numbers.size), np.uint8)
    planes[0] = zigzag  # the cast keeps the low byte
    np.right_shift(zigzag, _EIGHT, out=planes[1], casting="unsafe")
    return planes.reshape(-1)


def from_planes(planes: UInt8Array) -> UInt16Array:
    """The numbers of planes of an even number of bytes."""
    low, high = planes.reshape(2, -1)
    numbers = high.astype(np.uint16)
    numbers <<= _EIGHT
    numbers |= low
    signs = numbers & _ONE
    np.negative(signs, out=signs)
    numbers >>= _ONE
    numbers ^= signs
    return np.cumsum(numbers, dtype=np.uint16, out=numbers)
