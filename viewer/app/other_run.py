"""Another run on the same terrain, with ground, water and colours of its own, to stand right of a divider."""

from __future__ import annotations

from collections.abc import Callable

from viewer.app.channel_feed import ChannelFeed
from viewer.app.edit_report import edit_overlay
from viewer.app.run_book import RunBook
from viewer.app.shown_run import ShownRun
from viewer.app.water_feed import WaterFeed
from viewer.app.water_view import WaterView
from viewer.net import FrameLoader
from viewer.render import FrameInputs, RenderOptions
from viewer.world import Camera, Heightfield

__all__ = ["OtherRun"]


class OtherRun:
    """What is drawn of the other run.

    Args:
        shown: the run on the picture.
        other: id of the other run, on the same terrain.
        loader: where frames lie and are decoded.
        book: what is known of runs and their edits.
        main: the water of the run on the picture; the loader listens to it.
        channels: where velocity and maxima come from.
        request: asks for frame `index` of the other run.

    Attributes:
        run: the other run.
        feed: its water.
        water: its colours and arrows.
    """

    def __init__(
        self,
        shown: ShownRun,
        other: str,
        loader: FrameLoader,
        book: RunBook,
        main: WaterFeed,
        channels: ChannelFeed,
        request: Callable[[int], None],
    ) -> None:
        ground = shown.heightfield
        field = Heightfield(shown.grid, shown.document.base, ground.outside)
        field.cover(ground.outside, ground.imagery)
        self.run = ShownRun(book.runs[other], shown.document.base, loader, field)
        self.feed = WaterFeed(loader, book, request, main)
        self.water = WaterView(self.feed, channels)
        self._book = book

    def advance(self, time: float, options: RenderOptions) -> bool:
        """Move to playback time `time` [s]; return whether its picture has changed."""
        run = self.run
        run.info = self._book.runs.get(run.run, run.info)
        edits = self._book.edits_below(run.run, run.info.revision)
        if edits != run.document.edits:
            run.document.mirror(run.info.revision, edits, False, False)
        changed = self.feed.advance(run, time)
        changed |= run.refresh_ground(self.feed.moved)
        changed |= self.water.advance(run, options)
        return changed

    def inputs(self, camera: Camera, options: RenderOptions, is_outdated: bool) -> FrameInputs:
        """Return all that its picture depends on."""
        plain = FrameInputs(
            camera,
            self.feed.pair,
            edit_overlay(self.run, None),
            options,
            is_outdated=is_outdated,
        )
        return self.water.dressed(plain)
