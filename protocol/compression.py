"""Zstandard with a ceiling on what is unpacked: a declared size is checked before memory is taken."""

from __future__ import annotations

import zstandard

from protocol.errors import FrameError, TooLarge

ZSTD_LEVEL = 1
"""Fastest level; depths and elevations gain little from higher ones."""


def compress(raw: bytes | memoryview) -> bytes:
    """One zstd frame that declares its content size."""
    return zstandard.ZstdCompressor(level=ZSTD_LEVEL).compress(raw)


def decompress(packed: bytes, raw_size: int, max_size: int) -> bytes:
    """Unpack one zstd frame.

    Args:
        packed: the zstd frame.
        raw_size: size [bytes] that the message declares.
        max_size: largest size [bytes] allowed here.

    Raises:
        TooLarge: when the declared size passes max_size.
        FrameError: when the data is not a zstd frame of exactly raw_size bytes.
    """
    if raw_size > max_size:
        raise TooLarge(f"A payload declares {raw_size} bytes; up to {max_size} are allowed here.")
    try:
        declared = zstandard.frame_content_size(packed)
        if declared != raw_size:
            raise FrameError(f"A payload declares {raw_size} bytes, but its zstd header {declared}.")
        raw = zstandard.ZstdDecompressor().decompress(
            packed, max_output_size=raw_size, allow_extra_data=False
        )
    except zstandard.ZstdError as error:
        raise FrameError(f"A payload is not valid zstd: {error}.") from error
    return raw
