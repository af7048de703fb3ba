"""The lowered bed of a frame: what is packed comes back, and what cannot be is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import BlockLayout, FrameError, limits
from protocol.bed_change import pack_bed, unpack_bed

LAYOUT = BlockLayout(4, 6)


@given(st.sets(st.integers(0, 23)), st.data())
def test_cells_and_values_come_back_bit_for_bit(places: set[int], data: st.DataObject) -> None:
    heights = data.draw(
        st.lists(
            st.floats(allow_nan=False, allow_infinity=False, width=32),
            min_size=len(places),
            max_size=len(places),
        )
    )
    bed = np.array(sorted(places), np.int64), np.array(heights, np.float32)
    cells, values = unpack_bed(*pack_bed(bed, LAYOUT), LAYOUT)
    assert cells.dtype == np.int64
    assert values.dtype == np.float32
    np.testing.assert_array_equal(cells, bed[0])
    assert values.tobytes() == bed[1].tobytes()


def test_no_bed_takes_no_bytes() -> None:
    assert pack_bed(None, LAYOUT) == (b"", b"")
    assert unpack_bed(b"", b"", LAYOUT)[0].size == 0


def words(*numbers: int) -> bytes:
    return np.array(numbers, "<u4").tobytes()


@pytest.mark.parametrize(
    ("cells", "values"),
    [
        (words(1, 2), words(0)),
        (words(1) + b"\0", words(0)),
        (words(1), words(0)[:3]),
        (words(24), words(0)),
        (words(2, 1), words(0, 0)),
        (words(2, 2), words(0, 0)),
        (words(1), np.array([np.nan], "<f4").tobytes()),
        (words(1), np.array([np.inf], "<f4").tobytes()),
    ],
    ids=["lengths", "cells cut", "values cut", "off the grid", "falling", "twice", "nan", "infinite"],
)
def test_what_cannot_be_is_refused(cells: bytes, values: bytes) -> None:
    with pytest.raises(FrameError):
        unpack_bed(cells, values, LAYOUT)


def test_more_cells_than_a_frame_tells_are_refused_before_they_are_packed() -> None:
    count = limits.MAX_BED_CELLS + 1
    bed = np.arange(count, dtype=np.int64), np.zeros(count, np.float32)
    with pytest.raises(FrameError, match="65536"):
        pack_bed(bed, BlockLayout(300, 300))
