"""How the water is coloured, and where it flows: what the user wants, as far as the values are at hand."""

from __future__ import annotations

from viewer.app.channel_feed import ChannelFeed
from viewer.app.shown_run import ShownRun
from viewer.net import ChannelFields, ChannelKey, FrameKey
from viewer.render import CellField, Colouring, RenderOptions, WaterPair
from viewer.units import Units
from viewer.view_status import LegendRow, clock_text, time_text
from viewer.world import ClassScale, WaterColour, water_scale

__all__ = ["WaterLook"]

AHEAD = 3
"""Frames after the one shown whose velocity is fetched beforehand."""
MAXIMA_STEPS = 60
"""The maxima shown are renewed this many times in the length of a run."""
_FIELDS = {
    WaterColour.MAX_DEPTH: "max_depth",
    WaterColour.MAX_SPEED: "max_speed",
    WaterColour.MAX_HAZARD: "max_hazard",
    WaterColour.ARRIVAL: "arrival",
}
Velocities = tuple[ChannelFields, ChannelFields]


class WaterLook:
    """Turns what is wanted into what the picture of one run needs.

    Args:
        channels: where velocity and maxima come from.

    Attributes:
        colouring: the classes on the picture; None for natural water, wanted or not yet at hand.
        velocities: those of both frames on the picture, or the nearest at hand; None when none are, or none
            are wanted.
        note: why what is wanted is not on the picture, one sentence; empty when it is.
    """

    def __init__(self, channels: ChannelFeed) -> None:
        self.colouring: Colouring | None = None
        self.velocities: Velocities | None = None
        self.note = ""
        self._channels = channels
        self._scale: tuple[object, ClassScale | None] = (None, None)

    def follow(
        self,
        shown: ShownRun,
        keys: tuple[FrameKey, FrameKey] | None,
        pair: WaterPair | None,
        options: RenderOptions,
    ) -> bool:
        """Bring everything up to date; return whether the picture has changed.

        Args:
            shown: the run.
            keys: the frames of its water on the picture.
            pair: that water.
            options: what the user wants.
        """
        before = self.colouring, self.velocities
        colour = options.water_colour
        self.note = self._missing(shown, options)
        wants_velocity = options.flow_arrows or colour.channel == "velocity"
        self.velocities = None
        if wants_velocity and keys is not None and self._keeps(shown, "velocity"):
            self.velocities = self._velocities(shown, keys)
        scale = self._scale_of(shown, colour, options.units)
        self.colouring = None if scale is None else self._colouring(shown, keys, colour, scale)
        if pair is None:
            self.colouring = None
        return self._name(*before) != self._name(self.colouring, self.velocities)

    def wanted(
        self, shown: ShownRun, keys: tuple[FrameKey, FrameKey], options: RenderOptions
    ) -> list[ChannelKey]:
        """Return the channels that the picture needs, most urgent first."""
        wanted: list[ChannelKey] = []
        if options.water_colour.channel == "maxima":
            wanted.append(self._maxima_key(shown, keys))
        if options.flow_arrows or options.water_colour.channel == "velocity":
            after = [shown.frame_key(keys[1][1] + k) for k in range(1, AHEAD + 1)]
            at_hand = [key for key in after if key[1] in shown.timeline]
            wanted += [(*key, "velocity") for key in (*keys, *at_hand)]
        return wanted

    def legend(self) -> tuple[LegendRow, ...]:
        """Return the classes on the picture, lowest first."""
        if self.colouring is None:
            return ()
        scale = self.colouring.scale
        return tuple(LegendRow(*row) for row in zip(scale.colours, scale.labels, strict=True))

    def offered(self, shown: ShownRun) -> tuple[str, ...]:
        """Return what the water of a run may be coloured by."""
        return tuple(
            colour.value
            for colour in WaterColour
            if colour.channel is None or self._keeps(shown, colour.channel)
        )

    def _keeps(self, shown: ShownRun, channel: str) -> bool:
        return channel in shown.info.channels

    def _missing(self, shown: ShownRun, options: RenderOptions) -> str:
        channels = [options.water_colour.channel, "velocity" if options.flow_arrows else None]
        for channel in channels:
            if channel is not None and not self._keeps(shown, channel):
                return f"This run does not keep the channel {channel}."
        return ""

    def _colouring(
        self,
        shown: ShownRun,
        keys: tuple[FrameKey, FrameKey] | None,
        colour: WaterColour,
        scale: ClassScale,
    ) -> Colouring | None:
        if colour.channel is None:
            return Colouring(colour, scale)
        if keys is None or not self._keeps(shown, colour.channel):
            return None
        if colour.channel == "velocity":
            if self.velocities is None:
                self.note = self.note or "Velocity is on its way."
                return None
            fields = tuple(CellField((*at.key, "speed"), at.fields["speed"]) for at in self.velocities)
            return Colouring(colour, scale, fields)
        key = self._maxima_key(shown, keys)
        maxima = self._nearest(shown, key)
        if maxima is None:
            self.note = self.note or "Maxima are on their way."
            return None
        if maxima.key != key:
            self.note = f"Maxima are on their way; the picture has those until {time_text(maxima.time)}."
        elif maxima.index < key[1]:
            until = time_text(maxima.time)
            self.note = f"This run keeps maxima with some frames only; these are those until {until}."
        name = _FIELDS[colour]
        return Colouring(colour, scale, (CellField((*maxima.key, name), maxima.fields[name]),))

    def _velocities(self, shown: ShownRun, keys: tuple[FrameKey, FrameKey]) -> Velocities | None:
        first, second = (self._nearest(shown, (*key, "velocity")) for key in keys)
        if first is None or second is None:
            return None
        late = [at.time for at, key in zip((first, second), keys, strict=True) if at.index != key[1]]
        if late:
            self.note = f"Velocity is on its way; the picture has that of {time_text(late[0])}."
        return first, second

    def _nearest(self, shown: ShownRun, key: ChannelKey) -> ChannelFields | None:
        """Return a channel, or while it is on its way the one nearest in time: colours must not flicker."""
        exact = self._channels.get(key)
        if exact is not None:
            return exact
        known = [at for at in self._channels.loader.ready(key[2]) if shown.frame_key(at[1])[0] == at[0]]
        if not known:
            return None
        return self._channels.get(min(known, key=lambda at: (abs(at[1] - key[1]), at[1])))

    def _maxima_key(self, shown: ShownRun, keys: tuple[FrameKey, FrameKey]) -> ChannelKey:
        """Maxima change little from frame to frame: those of round indices stand for the ones after them."""
        frames = max(1, round(shown.info.duration / shown.info.output_interval))
        step = max(1, frames // MAXIMA_STEPS)
        newest = max(shown.info.frame_count - 1, 0)
        index = keys[0][1]
        if index < newest:
            index = max(index // step * step, shown.branch_index if index >= shown.branch_index else 0)
        return (*shown.frame_key(index), "maxima")

    def _scale_of(self, shown: ShownRun, wanted: WaterColour, units: Units) -> ClassScale | None:
        start = shown.info.start_time
        made_for = (wanted, shown.info.duration, start, units)
        if self._scale[0] != made_for:
            clock = None if start is None else (lambda time: clock_text(start, time)[11:16])
            self._scale = (made_for, water_scale(wanted, shown.info.duration, clock, units))
        return self._scale[1]

    @staticmethod
    def _name(colouring: Colouring | None, velocities: Velocities | None) -> object:
        fields = () if colouring is None else tuple(field.key for field in colouring.fields)
        moving = () if velocities is None else tuple(at.key for at in velocities)
        return colouring is None, None if colouring is None else colouring.scale, fields, moving
