"""How the water is coloured: what the user wants, as far as the values for it are at hand."""

from __future__ import annotations

from viewer.app.shown_run import ShownRun
from viewer.render import Colouring
from viewer.view_status import LegendRow, clock_text
from viewer.world import ClassScale, WaterColour, water_scale

__all__ = ["WaterLook"]


class WaterLook:
    """Turns the wish for a colouring into what the picture needs.

    Attributes:
        colouring: the classes on the picture; None for natural water, wanted or not yet at hand.
        note: why what is wanted is not on the picture, one sentence; empty when it is.
    """

    def __init__(self) -> None:
        self.colouring: Colouring | None = None
        self.note = ""
        self._scale: tuple[object, ClassScale | None] = (None, None)

    def follow(self, shown: ShownRun, wanted: WaterColour) -> bool:
        """Bring the colouring up to date; return whether it has changed."""
        before = self.colouring
        scale = self._scale_of(shown, wanted)
        self.colouring = None if scale is None else self._colouring(wanted, scale)
        return self.colouring != before

    def legend(self) -> tuple[LegendRow, ...]:
        """Return the classes on the picture, lowest first."""
        if self.colouring is None:
            return ()
        scale = self.colouring.scale
        return tuple(LegendRow(*row) for row in zip(scale.colours, scale.labels, strict=True))

    def _colouring(self, wanted: WaterColour, scale: ClassScale) -> Colouring | None:
        return Colouring(wanted, scale) if wanted.channel is None else None

    def _scale_of(self, shown: ShownRun, wanted: WaterColour) -> ClassScale | None:
        start = shown.info.start_time
        made_for = (wanted, shown.info.duration, start)
        if self._scale[0] != made_for:
            clock = None if start is None else (lambda time: clock_text(start, time)[11:16])
            self._scale = (made_for, water_scale(wanted, shown.info.duration, clock))
        return self._scale[1]
