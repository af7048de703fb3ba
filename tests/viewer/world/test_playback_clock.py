import pytest

from viewer.world import PlaybackClock


def test_a_paused_clock_stands() -> None:
    clock = PlaybackClock()

    assert clock.advance(10.0, 0.0, 500.0) == 0.0


def test_playing_moves_by_speed_times_wall_time() -> None:
    clock = PlaybackClock(speed=30.0)
    clock.play()

    assert clock.advance(2.0, 0.0, 500.0) == 60.0


def test_many_short_spans_play_as_far_as_one_long_one() -> None:
    long, short = PlaybackClock(40.0), PlaybackClock(40.0)
    long.play()
    short.play()
    long.advance(3.0, 0.0, 1e4)
    for _ in range(300):
        short.advance(0.01, 0.0, 1e4)

    assert short.time == pytest.approx(long.time)


def test_time_never_passes_the_newest_frame() -> None:
    clock = PlaybackClock(100.0)
    clock.play()

    assert clock.advance(100.0, 0.0, 120.0) == 120.0
    assert clock.is_playing


def test_a_loop_begins_again() -> None:
    clock = PlaybackClock(10.0)
    clock.loops = True
    clock.play()
    clock.seek(95.0)

    assert clock.advance(1.0, 20.0, 100.0) == pytest.approx(25.0)


def test_following_closes_in_on_the_newest_frame_at_any_picture_rate() -> None:
    coarse, fine = PlaybackClock(), PlaybackClock()
    coarse.follow_live()
    fine.follow_live()
    coarse.advance(1.0, 0.0, 100.0)
    for _ in range(100):
        fine.advance(0.01, 0.0, 100.0)

    assert fine.time == pytest.approx(coarse.time)
    assert 85.0 < coarse.time < 100.0


def test_seeking_and_pausing_end_following() -> None:
    clock = PlaybackClock()
    clock.follow_live()
    clock.seek(33.0)
    assert not clock.follows_live
    assert clock.time == 33.0

    clock.follow_live()
    clock.pause()
    assert not clock.follows_live
    assert not clock.is_playing


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_a_speed_that_is_none_is_refused(speed: float) -> None:
    with pytest.raises(ValueError, match="playback speed"):
        PlaybackClock(speed)
