import math
from collections.abc import Iterator

import pytest

from tests.viewer.app.test_shown_run import branch
from tests.viewer.tiny_service import valley
from viewer.app.playback import Playback
from viewer.app.shown_run import ShownRun
from viewer.commands import (
    Command,
    CommandError,
    FollowLive,
    Loop,
    Pause,
    Play,
    Seek,
    SetSpeed,
    TogglePlay,
    Undo,
)
from viewer.net import FrameLoader
from viewer.world import PlaybackClock


@pytest.fixture
def shown() -> Iterator[ShownRun]:
    """A branch at 90 s of which frames up to 110 s are computed."""
    loader = FrameLoader()
    yield ShownRun(branch(), valley(), loader)
    loader.close()


@pytest.fixture
def playback(shown: ShownRun) -> Playback:
    return Playback(PlaybackClock(), lambda: shown)


def test_seeking_ends_at_what_is_computed(playback: Playback) -> None:
    assert playback.carry_out(Seek(1e9))
    assert playback.clock.time == 110.0


def test_play_and_pause_take_turns(playback: Playback) -> None:
    states = []
    for command in (Play(), TogglePlay(), TogglePlay(), Pause()):
        assert playback.carry_out(command)
        states.append(playback.clock.is_playing)

    assert states == [True, False, True, False]


def test_following_live_is_left_by_pausing(playback: Playback) -> None:
    playback.carry_out(FollowLive())
    assert playback.clock.follows_live
    playback.carry_out(FollowLive(False))
    assert not playback.clock.follows_live


@pytest.mark.parametrize("command", [SetSpeed(0.0), SetSpeed(math.inf), Seek(math.nan)])
def test_a_senseless_number_is_refused(playback: Playback, command: Command) -> None:
    with pytest.raises(CommandError, match="is not allowed"):
        playback.carry_out(command)


def test_other_commands_are_left_to_others(playback: Playback) -> None:
    assert not playback.carry_out(Undo())


def test_a_run_plays_in_a_minute_but_never_slower_than_life(playback: Playback) -> None:
    playback.fit_speed(7200.0)
    assert playback.clock.speed == 120.0
    playback.fit_speed(10.0)
    assert playback.clock.speed == 1.0


def test_the_clock_runs_at_its_speed_up_to_the_frames_at_hand(playback: Playback, shown: ShownRun) -> None:
    playback.clock.set_speed(10.0)
    playback.clock.seek(50.0)
    playback.carry_out(Play())

    assert playback.advance(shown, 2.0)
    assert playback.clock.time == 70.0
    playback.advance(shown, 60.0)
    assert playback.clock.time == 90.0  # the branch point; none of its own frames has come


def test_playing_begins_again_at_the_end_when_it_loops(playback: Playback, shown: ShownRun) -> None:
    playback.clock.set_speed(10.0)
    playback.clock.seek(80.0)
    for command in (Loop(), Play()):
        assert playback.carry_out(command)
    playback.advance(shown, 2.0)

    assert playback.clock.time == 10.0
