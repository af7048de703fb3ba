"""Byte planes: what goes in comes out, and like neighbours leave high bytes of 0."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from protocol.byte_planes import from_planes, to_planes


@given(st.lists(st.integers(0, 65535), max_size=200))
def test_every_row_of_numbers_comes_back(numbers: list[int]) -> None:
    x = np.array(numbers, np.uint16)
    np.testing.assert_array_equal(from_planes(to_planes(x)), x)


@given(st.lists(st.integers(0, 65535), max_size=50))
def test_the_planes_are_those_that_the_page_on_the_protocol_describes(numbers: list[int]) -> None:
    zigzag, before = [], 0
    for x in numbers:
        d = (x - before + 32768) % 65536 - 32768
        zigzag.append(2 * d if d >= 0 else -2 * d - 1)
        before = x
    expected = bytes(z % 256 for z in zigzag) + bytes(z // 256 for z in zigzag)
    assert to_planes(np.array(numbers, np.uint16)).tobytes() == expected


def test_small_steps_up_and_down_have_no_high_bytes() -> None:
    x = (1000 + np.cumsum(np.tile([100, -100, 127, -128], 20))).astype(np.uint16)
    high = to_planes(x)[x.size :]
    assert high[0] > 0
    assert not high[1:].any()
