import pytest

from viewer.world import FrameCache


def test_a_frame_comes_back_as_it_was_stored() -> None:
    cache = FrameCache(1000)
    cache.store(4, b"depths", key_index=3)

    assert cache.get(4) == b"depths"
    assert cache.key_of(4) == 3
    assert cache.get(5) is None


def test_the_budget_is_kept() -> None:
    cache = FrameCache(1000)
    for index in range(50):
        cache.store(index, bytes(90), key_index=index)
        assert cache.size_bytes <= 1000

    assert cache.size_bytes == 90 * len(cache)
    assert len(cache) == 11


def test_what_lies_farthest_from_the_playhead_goes_first() -> None:
    cache = FrameCache(500)
    cache.playhead = 10
    for index in (10, 2, 11, 9, 12):
        cache.store(index, bytes(100), key_index=index)

    assert cache.store(13, bytes(100), key_index=13) == [2]


def test_a_key_frame_outlives_the_frames_that_lean_on_it() -> None:
    cache = FrameCache(400)
    cache.playhead = 6
    for index in range(7):
        cache.store(index, bytes(100), key_index=0)

    assert 0 in cache
    assert 6 in cache
    assert all(cache.key_of(index) == 0 for index in cache.indices)


def test_storing_a_frame_again_replaces_it() -> None:
    cache = FrameCache(1000)
    cache.store(1, bytes(300), key_index=1)
    cache.store(1, bytes(100), key_index=1)

    assert cache.size_bytes == 100


def test_dropping_a_tail_frees_its_bytes() -> None:
    cache = FrameCache(1000)
    for index in range(5):
        cache.store(index, bytes(10), key_index=0)

    assert cache.drop_from(3) == [3, 4]
    assert cache.size_bytes == 30
    cache.clear()
    assert (cache.size_bytes, len(cache)) == (0, 0)


def test_a_budget_of_none_is_refused() -> None:
    with pytest.raises(ValueError, match="budget"):
        FrameCache(0)
