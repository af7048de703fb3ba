"""The renderer and what it draws now, the same in the window and off screen."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.app.picture_file import picture_size, save_png
from viewer.app.picture_pace import PicturePace
from viewer.app.picture_quality import SOFTWARE_SCALE, interactive, is_software, still
from viewer.app.picture_text import only_warnings
from viewer.commands import SavePicture
from viewer.render import FrameInputs, FrameStats, Renderer, RenderOptions, check_context
from viewer.world import Heightfield

__all__ = ["Scene", "Stage"]

EMPTY_COLOUR = (0.086, 0.102, 0.118, 1.0)


class Scene(Protocol):
    """What there is to draw; `viewer.app.ViewerApp` is one."""

    @property
    def heightfield(self) -> Heightfield | None:
        """The ground, None before the terrain has come."""

    def frame_inputs(self) -> FrameInputs | None:
        """Return all the picture depends on, None when there is nothing to draw yet."""

    def note_painted(self, size: tuple[int, int]) -> None:
        """The inputs given last are on the picture now, of width and height `size` [pixels]."""

    def take_picture_order(self) -> SavePicture | None:
        """Return how and where the picture is to be written, once."""

    def complain(self, sentence: str) -> None:
        """Show a sentence to the user."""


class Stage:
    """Draws a scene with a renderer that is made anew when the terrain is another one.

    Args:
        scene: what there is to draw.
        make_context: gives the OpenGL context; called once by `open`.

    Attributes:
        stats: what the last picture cost, None before the first.
        pictures: number of pictures drawn with a terrain.
        pace: how fine the scene is drawn in a window where OpenGL runs on the processor.
    """

    def __init__(
        self, scene: Scene, make_context: Callable[[], moderngl.Context] = moderngl.create_context
    ) -> None:
        self._scene = scene
        self._make_context = make_context
        self._context: moderngl.Context | None = None
        self._renderer: Renderer | None = None
        self._other: Renderer | None = None
        self._other_ground: Heightfield | None = None
        self._divider: float | None = None
        self.pace = PicturePace(SOFTWARE_SCALE)
        self._clock: moderngl.Query | None = None
        self._ground: tuple[Heightfield, int] | None = None
        self.stats: FrameStats | None = None
        self.pictures = 0

    @property
    def context(self) -> moderngl.Context:
        """The OpenGL context; `open` must have been called."""
        assert self._context is not None, "the stage is not open"
        return self._context

    def open(self) -> None:
        """Take the OpenGL context.

        Raises:
            ContextError: it is older than 4.1.
        """
        self._context = check_context(self._make_context())

    @property
    def render_scale(self) -> float:
        """Pixels of the scene for each pixel of a picture in the window, along one side."""
        return self.pace.scale if is_software(self.context) else 1.0

    def paint(self, framebuffer: int, width: int, height: int) -> None:
        """Draw the scene of a window into framebuffer object number `framebuffer`."""
        target, size = self.context.detect_framebuffer(framebuffer), (width, height)
        if not is_software(self.context):
            self.paint_to(target, size)
            return
        if self._clock is None:
            self._clock = self.context.query(time=True)
        elif self.stats is not None:
            # What the last picture took: it is done by now, and nobody waits for the answer.
            self.pace.note(self._clock.elapsed / 1e6)
        scale = self.pace.scale
        with self._clock:
            self.paint_to(target, size, lambda options: interactive(options, scale))

    def paint_to(
        self,
        target: moderngl.Framebuffer,
        size: tuple[int, int],
        quality: Callable[[RenderOptions], RenderOptions] | None = None,
    ) -> None:
        """Draw the scene.

        Args:
            target: where to draw.
            size: its width and height [pixels].
            quality: makes of the user's options those of this picture.
        """
        inputs = self._scene.frame_inputs()
        heightfield = self._scene.heightfield
        if inputs is None or heightfield is None:
            target.use()
            target.viewport = (0, 0, *size)
            target.clear(*EMPTY_COLOUR)
            return
        ground = (heightfield, heightfield.cover_revision)
        if self._renderer is None or ground != self._ground:
            if self._renderer is not None:
                self._renderer.release()
            self._renderer = Renderer(self.context, heightfield)
            self._ground = ground
        order = self._scene.take_picture_order()
        if order is not None:
            self._write(order, inputs, size)  # first: picking needs the picture on the screen to be the last
        if quality is not None:
            inputs = dataclasses.replace(inputs, options=quality(inputs.options))
        self.stats = self._draw(target, size, inputs)
        self._divider = None if inputs.beside is None else inputs.beside.at * size[0]
        self.pictures += 1
        self._scene.note_painted(size)

    def ground_at(self, x: float, y: float) -> tuple[float, float] | None:
        """Return the map point (x, y) [m] seen at a pixel of the last picture, None for the sky."""
        is_beside = self._divider is not None and x >= self._divider
        renderer = self._other if is_beside else self._renderer
        point = None if renderer is None else renderer.pick(x, y)
        return None if point is None else (point[0], point[1])

    def pixels(self, target: moderngl.Framebuffer, size: tuple[int, int]) -> npt.NDArray[np.uint8]:
        """Return the colours of `target`, shape [height, width, 3], first row on top."""
        return Renderer.read_pixels(target, size)

    def close(self) -> None:
        """Release the renderer; the context belongs to whoever made it."""
        if self._renderer is not None:
            self._renderer.release()
        self._close_other()
        self._renderer = None
        self._ground = None
        self._clock = None
        self._context = None

    def _draw(self, target: moderngl.Framebuffer, size: tuple[int, int], inputs: FrameInputs) -> FrameStats:
        """Draw the run, and right of the divider the other one, if there is one."""
        assert self._renderer is not None
        beside = inputs.beside
        if beside is None:
            self._close_other()
            return self._renderer.draw(target, size, inputs)
        if self._other is None or beside.heightfield is not self._other_ground:
            self._close_other()
            self._other, self._other_ground = Renderer(self.context, beside.heightfield), beside.heightfield
        theirs = dataclasses.replace(beside.inputs, options=inputs.options, hud=None)
        self._other.draw(target, size, theirs, (beside.at, 1.0))
        return self._renderer.draw(target, size, inputs, (0.0, beside.at))

    def _close_other(self) -> None:
        if self._other is not None:
            self._other.release()
        self._other = self._other_ground = None

    def _write(self, order: SavePicture, inputs: FrameInputs, shown: tuple[int, int]) -> None:
        assert self._renderer is not None
        size = picture_size(order, shown)
        longest = int(self.context.info["GL_MAX_RENDERBUFFER_SIZE"])
        options = still(inputs.options)
        scale = min(options.render_scale, longest / max(size))
        if not order.with_text and inputs.hud is not None:
            inputs = dataclasses.replace(inputs, hud=only_warnings(inputs.hud), marks=())
        inputs = dataclasses.replace(inputs, options=dataclasses.replace(options, render_scale=scale))
        colour = self.context.renderbuffer(size, 3)
        target = self.context.framebuffer([colour])
        try:
            self._draw(target, size, inputs)
            save_png(Path(order.path), self.pixels(target, size))
        except OSError as error:
            self._scene.complain(f"the picture {order.path} could not be written: {error}")
        else:
            self._scene.complain(f"picture of {size[0]} x {size[1]} pixels written to {order.path}")
        finally:
            target.release()
            colour.release()
