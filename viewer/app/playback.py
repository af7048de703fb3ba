"""Playing what is computed: the commands of the playback clock, and how far it may run."""

from __future__ import annotations

import math
from collections.abc import Callable

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
)
from viewer.world import PlaybackClock

__all__ = ["Playback"]

PLAYBACK_LENGTH_S = 60.0
"""Wall time in which a whole run plays at the speed chosen first [s]."""


class Playback:
    """The playback clock with the commands that move it.

    Args:
        require_run: returns the shown run, or raises CommandError.

    Attributes:
        clock: the playback time.
    """

    def __init__(self, clock: PlaybackClock, require_run: Callable[[], ShownRun]) -> None:
        self.clock = clock
        self._require_run = require_run

    def carry_out(self, command: Command) -> bool:
        """Carry out a playback command; return False when it is none.

        Raises:
            CommandError: a time or a speed that makes no sense, or no run is shown.
        """
        match command:
            case Play():
                self.clock.play()
            case Pause():
                self.clock.pause()
            case TogglePlay():
                self.clock.pause() if self.clock.is_playing else self.clock.play()
            case Seek(time):
                if not math.isfinite(time):
                    raise CommandError(f"Seek.time = {time!r} is not allowed; it must be finite")
                self.clock.seek(min(time, self._require_run().computed_until))
            case SetSpeed(factor):
                if not (math.isfinite(factor) and factor > 0.0):
                    raise CommandError(f"SetSpeed.factor = {factor!r} is not allowed; it must be above 0")
                self.clock.set_speed(factor)
            case Loop(on):
                self.clock.loops = on
            case FollowLive(on):
                self.clock.follow_live() if on else self.clock.pause()
            case _:
                return False
        return True

    def fit_speed(self, duration: float) -> None:
        """Choose the speed at which a run of `duration` [s] plays in about a minute."""
        self.clock.set_speed(max(1.0, duration / PLAYBACK_LENGTH_S))

    def advance(self, shown: ShownRun, wall_dt: float) -> bool:
        """Move the clock on by `wall_dt` [s] of wall time; return whether the playback time has changed."""
        before = self.clock.time
        at_hand = max(shown.timeline.last_time, shown.branch_index * shown.info.output_interval)
        last = at_hand if before <= at_hand and self.clock.is_playing else shown.computed_until
        end = max(last, before if not self.clock.is_playing else last)
        return self.clock.advance(wall_dt, 0.0, end) != before
