"""Writes the text of the picture, and knows when what is drawn has grown old."""

from __future__ import annotations

import math
import time as wall_clock

from viewer.app.measuring import Measuring
from viewer.app.picture_text import hud_text, loss_notice, only_warnings
from viewer.app.run_control import RunControl
from viewer.app.shown_run import ShownRun
from viewer.render import HudText, RenderOptions
from viewer.world import PlaybackClock

__all__ = ["HudWriter"]

PERIOD_S = 0.5
"""The picture is drawn anew at most this often when only its text has changed [s]."""


class HudWriter:
    """The text of the picture.

    Args:
        control: the shown run and the dealings with the service.
        clock: the playback clock.
        measuring: the measuring tool, which has its result on the picture.
    """

    def __init__(self, control: RunControl, clock: PlaybackClock, measuring: Measuring) -> None:
        self._control = control
        self._clock = clock
        self._measuring = measuring
        self._drawn: HudText | None = None
        self._checked = -math.inf

    def write(self, shown: ShownRun, options: RenderOptions) -> HudText:
        """Return the text as it is now; it counts as drawn."""
        self._drawn = self._text(shown, options)
        return self._drawn

    def is_old(self, shown: ShownRun, options: RenderOptions, now: float) -> bool:
        """Whether the picture is to be drawn anew for its text alone; looked at not too often.

        Args:
            shown: the run on the picture.
            options: what the user has chosen.
            now: wall time [s, monotonic].
        """
        if now - self._checked < PERIOD_S:
            return False
        self._checked = now
        return self._text(shown, options) != self._drawn

    def _text(self, shown: ShownRun, options: RenderOptions) -> HudText:
        desk = self._control.desk
        notice = ""
        if not desk.is_open:
            notice = loss_notice(desk.connection_sentence(), desk.data_age(wall_clock.monotonic()))
        text = hud_text(
            shown,
            self._clock.time,
            desk.book.progress.get(shown.run),
            self._control.recalculated,
            notice,
            self._measuring.text(shown, options.units),
        )
        return text if options.show_text else only_warnings(text)
