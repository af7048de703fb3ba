"""Everything about how the water is shown, behind one door for the state machine."""

from __future__ import annotations

import dataclasses

from viewer.app.shown_run import ShownRun
from viewer.app.water_look import WaterLook
from viewer.render import FrameInputs, RenderOptions
from viewer.view_status import ViewStatus
from viewer.world import WaterColour

__all__ = ["WaterView"]


class WaterView:
    """Colours of the water, for picture and status."""

    def __init__(self) -> None:
        self.look = WaterLook()

    def advance(self, shown: ShownRun, options: RenderOptions) -> bool:
        """Follow the water on the picture; return whether the picture has changed."""
        return self.look.follow(shown, options.water_colour)

    def dressed(self, inputs: FrameInputs) -> FrameInputs:
        """Return the inputs of a picture with the colours of the water."""
        return dataclasses.replace(inputs, colouring=self.look.colouring)

    def told(self, status: ViewStatus, options: RenderOptions) -> ViewStatus:
        """Return `status` with what is shown of the water."""
        return dataclasses.replace(
            status,
            water_colour=options.water_colour.value,
            water_colours=tuple(colour.value for colour in WaterColour if colour.channel is None),
            water_note=self.look.note,
            legend=self.look.legend(),
            flow_arrows=options.flow_arrows,
        )
