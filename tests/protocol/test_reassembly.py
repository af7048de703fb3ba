import pytest

from protocol import SequenceError, TooLarge, limits
from protocol.reassembly import PartAssembler


def assembler() -> PartAssembler:
    return PartAssembler("frame", 100)


def test_parts_in_order_make_the_whole() -> None:
    parts = assembler()
    assert parts.add("a", 0, 3, b"one") is None
    assert parts.add("a", 1, 3, b"two") is None
    assert parts.add("a", 2, 3, b"three") == b"onetwothree"


def test_a_single_part_is_the_whole() -> None:
    assert assembler().add("a", 0, 1, b"one") == b"one"


def test_another_thing_may_follow() -> None:
    parts = assembler()
    parts.add("a", 0, 2, b"x" * 60)
    parts.add("a", 1, 2, b"x")
    assert parts.add("b", 0, 2, b"y" * 60) is None
    assert parts.add("b", 1, 2, b"z") == b"y" * 60 + b"z"


@pytest.mark.parametrize(
    "second",
    [("a", 0, 3), ("a", 2, 3), ("a", 1, 2), ("a", 1, 4), ("b", 1, 3), ("b", 0, 3)],
    ids=["again", "skipped", "fewer", "more", "of-another", "another-begun"],
)
def test_a_part_that_was_not_due_is_refused(second: tuple[str, int, int]) -> None:
    parts = assembler()
    parts.add("a", 0, 3, b"one")
    with pytest.raises(SequenceError):
        parts.add(*second, b"two")


@pytest.mark.parametrize(("part", "count"), [(1, 3), (3, 3), (0, 0)])
def test_a_first_part_that_is_none_is_refused(part: int, count: int) -> None:
    with pytest.raises(SequenceError):
        assembler().add("a", part, count, b"")


def test_a_whole_above_the_limit_is_refused_at_once() -> None:
    parts = assembler()
    parts.add("a", 0, 3, b"x" * 60)
    with pytest.raises(TooLarge):
        parts.add("a", 1, 3, b"x" * 41)


def test_too_many_parts_are_refused() -> None:
    with pytest.raises(TooLarge):
        assembler().add("a", 0, limits.MAX_PARTS + 1, b"")
