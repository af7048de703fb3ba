import numpy as np
import pytest

from protocol import FrameError, TooLarge, decode_terrain, encode_terrain, limits, pack, unpack_server
from protocol.compression import compress


def test_a_bed_comes_back_bit_for_bit(rng: np.random.Generator) -> None:
    z_b = rng.normal(size=(300, 401)).astype(np.float32)
    parts = encode_terrain(3, "r", z_b)
    restored = decode_terrain(b"".join(part.data for part in parts), parts[0].shape)
    assert restored.dtype == np.float32
    assert restored.tobytes() == z_b.tobytes()


def test_a_large_bed_is_cut_into_parts_that_fit(rng: np.random.Generator) -> None:
    parts = encode_terrain(3, "r", rng.normal(size=(300, 401)))
    assert [part.part for part in parts] == list(range(len(parts)))
    assert {part.parts for part in parts} == {len(parts)} != {1}
    assert all(len(part.data) <= limits.PART_BYTES for part in parts)
    assert all(unpack_server(pack(part)) == part for part in parts)


def test_a_bed_that_is_not_contiguous_keeps_its_order(rng: np.random.Generator) -> None:
    z_b = rng.normal(size=(40, 30)).astype(np.float32).T[::-1]
    (part,) = encode_terrain(3, "r", z_b)
    np.testing.assert_array_equal(decode_terrain(part.data, (30, 40)), z_b)


def test_a_bed_of_another_size_is_refused() -> None:
    (part,) = encode_terrain(3, "r", np.zeros((4, 5)))
    with pytest.raises(FrameError):
        decode_terrain(part.data, (5, 5))


def test_a_bed_above_the_limit_is_refused() -> None:
    with pytest.raises(TooLarge):
        decode_terrain(b"", (1 << 16, 1 << 16))


def test_elevations_that_are_not_finite_are_refused() -> None:
    z_b = np.zeros((4, 5), dtype=np.float32)
    z_b[2, 3] = np.nan
    with pytest.raises(FrameError, match="finite"):
        decode_terrain(compress(z_b.tobytes()), (4, 5))
