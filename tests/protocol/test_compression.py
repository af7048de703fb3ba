import tracemalloc

import pytest
import zstandard

from protocol import FrameError, TooLarge
from protocol.compression import compress, decompress

RAW = bytes(range(256)) * 40


def test_what_is_packed_comes_back() -> None:
    assert decompress(compress(RAW), len(RAW), len(RAW)) == RAW
    assert decompress(compress(b""), 0, 0) == b""


def test_a_declared_size_above_the_limit_is_refused() -> None:
    with pytest.raises(TooLarge):
        decompress(compress(RAW), len(RAW), len(RAW) - 1)


def test_a_bomb_that_declares_too_little_is_refused_without_memory() -> None:
    bomb = zstandard.ZstdCompressor(level=19).compress(bytes(200_000_000))
    tracemalloc.start()
    try:
        with pytest.raises(FrameError):
            decompress(bomb, 1000, 1000)
        assert tracemalloc.get_traced_memory()[1] < 1_000_000
    finally:
        tracemalloc.stop()


def test_a_frame_without_its_size_is_refused() -> None:
    packed = zstandard.ZstdCompressor(write_content_size=False).compress(RAW)
    with pytest.raises(FrameError):
        decompress(packed, len(RAW), len(RAW))


def test_bytes_after_the_frame_are_refused() -> None:
    with pytest.raises(FrameError):
        decompress(compress(RAW) + b"x", len(RAW), len(RAW))
    with pytest.raises(FrameError):
        decompress(compress(RAW) + compress(RAW), len(RAW), len(RAW))


def test_a_frame_cut_at_any_byte_is_refused() -> None:
    packed = compress(RAW)
    for end in range(len(packed)):
        with pytest.raises(FrameError):
            decompress(packed[:end], len(RAW), len(RAW))


def test_a_size_other_than_declared_is_refused() -> None:
    with pytest.raises(FrameError):
        decompress(compress(RAW), len(RAW) + 1, 10**6)
