import contextlib

import msgpack
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import MalformedMessage, TooLarge, limits
from protocol.structure import check_structure

values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**64 - 1)
    | st.floats()
    | st.text(max_size=300)
    | st.integers(0, 70_000).map(bytes),
    lambda children: (
        st.lists(children, max_size=40) | st.dictionaries(st.text(max_size=10), children, max_size=40)
    ),
    max_leaves=30,
)


def count_items(value: object) -> int:
    if isinstance(value, dict):
        return 1 + sum(1 + count_items(item) for item in value.values())
    if isinstance(value, list):
        return 1 + sum(map(count_items, value))
    return 1


def depth_of(value: object) -> int:
    if isinstance(value, dict | list):
        items = value.values() if isinstance(value, dict) else value
        return 1 + max(map(depth_of, items), default=0)
    return 0


@given(values)
def test_the_limit_on_items_is_exact(value: object) -> None:
    data = msgpack.packb(value)
    if depth_of(value) > limits.MAX_DEPTH:
        with pytest.raises(TooLarge):
            check_structure(data, 10**6)
        return
    check_structure(data, count_items(value))
    with pytest.raises(TooLarge, match="items"):
        check_structure(data, count_items(value) - 1)


@given(values, st.data())
def test_a_value_cut_anywhere_is_malformed(value: object, data: st.DataObject) -> None:
    packed = msgpack.packb(value)
    end = data.draw(st.integers(0, len(packed) - 1))
    with pytest.raises((MalformedMessage, TooLarge)):
        check_structure(packed[:end], 10**6)


@given(st.binary(max_size=200))
def test_arbitrary_bytes_are_told_as_msgpack_tells_them(data: bytes) -> None:
    try:
        check_structure(data, 10**6)
    except (MalformedMessage, TooLarge):
        return
    # The shape is right; a text that is not UTF-8 or a list as key is for the codec to find.
    with contextlib.suppress(UnicodeDecodeError, TypeError):
        msgpack.unpackb(data, strict_map_key=False)


@pytest.mark.parametrize("depth", [limits.MAX_DEPTH, limits.MAX_DEPTH + 1])
def test_nesting_is_limited(depth: int) -> None:
    data = b"\x91" * depth + b"\xc0"
    if depth <= limits.MAX_DEPTH:
        check_structure(data, 100)
    else:
        with pytest.raises(TooLarge, match="deeper"):
            check_structure(data, 100)


@pytest.mark.parametrize(
    "value",
    [[0] * (limits.MAX_ARRAY_LENGTH + 1), dict.fromkeys(map(str, range(65))), "x" * 8193],
    ids=["array", "map", "text"],
)
def test_a_length_above_its_limit_is_too_large(value: object) -> None:
    with pytest.raises(TooLarge):
        check_structure(msgpack.packb(value), 10**6)
