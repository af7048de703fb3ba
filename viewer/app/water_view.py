"""Everything about how the water is shown, behind one door for the state machine."""

from __future__ import annotations

import dataclasses

from viewer.app.channel_feed import ChannelFeed
from viewer.app.shown_run import ShownRun
from viewer.app.water_feed import WaterFeed
from viewer.app.water_look import WaterLook
from viewer.net import ChannelLoader
from viewer.render import FrameInputs, RenderOptions
from viewer.view_status import ViewStatus
from viewer.world import FlowField

__all__ = ["WaterView"]


class WaterView:
    """Colours of the water and arrows of its flow, for picture and status.

    Args:
        feed: the water on the picture.
        channels: where velocity and maxima come from.
    """

    def __init__(self, feed: WaterFeed, channels: ChannelFeed) -> None:
        self.look = WaterLook(channels)
        self._feed = feed
        self._channels = channels

    @property
    def loader(self) -> ChannelLoader:
        """Where channels are unpacked and kept."""
        return self._channels.loader

    def advance(self, shown: ShownRun, options: RenderOptions) -> bool:
        """Follow the water on the picture; return whether the picture has changed."""
        keys = self._feed.keys
        if keys is not None:
            self._channels.want(self.look.wanted(shown, keys, options))
        return self.look.follow(shown, keys, self._feed.pair, options)

    def dressed(self, inputs: FrameInputs) -> FrameInputs:
        """Return the inputs of a picture with colours and arrows."""
        flow = None
        if inputs.options.flow_arrows and self.look.velocities is not None:
            first, second = self.look.velocities
            flow = FlowField(
                first.fields["u"], first.fields["v"], second.fields["u"], second.fields["v"], first.fast
            )
        return dataclasses.replace(inputs, colouring=self.look.colouring, flow=flow)

    def told(self, status: ViewStatus, shown: ShownRun, options: RenderOptions) -> ViewStatus:
        """Return `status` with what is shown of the water."""
        return dataclasses.replace(
            status,
            water_colour=options.water_colour.value,
            water_colours=self.look.offered(shown),
            water_note=self.look.note,
            legend=self.look.legend(),
            flow_arrows=options.flow_arrows,
        )

    def close(self) -> None:
        """End the unpacking. May be called twice."""
        self.loader.close()
