"""The playback time of the viewer: play, pause, seek, speed, follow the newest frame.

Playback time belongs to the viewer alone; the service knows nothing of it.
"""

from __future__ import annotations

import math

__all__ = ["PlaybackClock"]

_FOLLOW_TIME_CONSTANT_S = 0.4


class PlaybackClock:
    """Simulated time against wall time.

    Attributes:
        time: the playback time [s of simulation].
        speed: simulated seconds a wall second, > 0.
        is_playing: whether time moves.
        follows_live: whether time is drawn to the newest frame.
        loops: whether playing begins again at the end of what is known.
    """

    def __init__(self, speed: float = 60.0) -> None:
        """Begin at time 0, paused."""
        self.time = 0.0
        self.is_playing = False
        self.follows_live = False
        self.loops = False
        self.speed = 1.0
        self.set_speed(speed)

    def play(self) -> None:
        """Let time move at the chosen speed."""
        self.is_playing = True
        self.follows_live = False

    def pause(self) -> None:
        """Hold time still."""
        self.is_playing = False
        self.follows_live = False

    def follow_live(self) -> None:
        """Keep close behind the newest frame."""
        self.is_playing = True
        self.follows_live = True

    def seek(self, time: float) -> None:
        """Jump to a time [s, >= 0]; following ends, playing goes on if it did."""
        self.time = max(0.0, float(time))
        self.follows_live = False

    def set_speed(self, speed: float) -> None:
        """Choose the simulated seconds a wall second.

        Raises:
            ValueError: unless speed is finite and > 0.
        """
        if not (math.isfinite(speed) and speed > 0.0):
            raise ValueError(f"playback speed {speed!r} is not a finite number > 0")
        self.speed = float(speed)

    def advance(self, wall_dt: float, first_time: float, last_time: float) -> float:
        """Move on by a span of wall time and return the new playback time [s].

        Args:
            wall_dt: wall time since the last call [s].
            first_time: earliest time of which a frame is known [s].
            last_time: latest time of which a frame is known [s]; time never passes it.
        """
        if self.is_playing:
            if self.follows_live:
                behind = last_time - self.time
                self.time += behind * -math.expm1(-wall_dt / _FOLLOW_TIME_CONSTANT_S)
            else:
                self.time += self.speed * wall_dt
                if self.loops and self.time > last_time > first_time:
                    self.time = first_time + (self.time - first_time) % (last_time - first_time)
        self.time = min(max(self.time, first_time), max(first_time, last_time))
        return self.time
