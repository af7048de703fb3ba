"""The viewer without a window: the same state machine and renderer on an off-screen context."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt

from viewer.app.picture_file import save_png
from viewer.app.picture_quality import still
from viewer.app.script import ScriptStep
from viewer.app.stage import Stage
from viewer.app.viewer_app import ViewerApp
from viewer.errors import ViewerError
from viewer.render import RenderOptions, create_headless_context

__all__ = ["PICTURE_SIZE", "HeadlessError", "HeadlessSession"]

PICTURE_SIZE = (1280, 720)
IDLE_S = 0.02
PAINT_PERIOD_S = 0.4
"""While waiting, a picture is drawn at most this often: the processor belongs to the solver."""
SETTLE_TIMEOUT_S = 30.0
SIGN_OF_LIFE_S = 15.0
"""Who waits longer than this is told what for."""


class HeadlessError(ViewerError):
    """What was waited for did not come; the text says what."""


class HeadlessSession:
    """Drives a `ViewerApp` and draws its pictures into an off-screen framebuffer.

    Args:
        app: the state machine.
        folder: where pictures go; made if need be.
        size: width and height of the pictures [pixels].
        watch: called while waiting; raises a `ViewerError` when there is no use in waiting on.

    Attributes:
        pictures: file names of the pictures written so far, in order.
        first_picture_at: wall time of the first picture with water [s, monotonic], None before it.

    Raises:
        ContextError: no off-screen OpenGL 4.1 context.
    """

    def __init__(
        self,
        app: ViewerApp,
        folder: Path,
        size: tuple[int, int] = PICTURE_SIZE,
        watch: Callable[[], None] = lambda: None,
    ) -> None:
        self.app = app
        self.folder = folder
        self.size = size
        self.pictures: list[str] = []
        self.first_picture_at: float | None = None
        self._watch = watch
        self.stage = Stage(app, create_headless_context)
        self.stage.open()
        context = self.stage.context
        self._colour = context.texture(size, 3)
        self._target = context.framebuffer([self._colour])
        self._painted_at = 0.0
        self._is_stale = True
        folder.mkdir(parents=True, exist_ok=True)

    def pump(
        self,
        until: Callable[[], bool],
        what: str,
        timeout_s: float,
        paint_period_s: float = PAINT_PERIOD_S,
    ) -> None:
        """Let everything go on until a condition holds.

        Args:
            until: the condition.
            what: what is waited for, in words.
            timeout_s: wall time after which to give up [s].
            paint_period_s: least wall time between two pictures drawn meanwhile [s].

        Raises:
            HeadlessError: it did not hold in time.
        """
        begun = told = time.monotonic()
        end = begun + timeout_s
        while True:
            now = time.monotonic()
            if now - told >= SIGN_OF_LIFE_S:
                told = now
                print(f"fev-viewer: waiting for {what} ({now - begun:.0f} s)", file=sys.stderr, flush=True)
            self._is_stale |= self.app.advance(now)
            if self._is_stale and now - self._painted_at >= paint_period_s:
                self.paint()
            if until():
                return
            if now > end:
                said = f"; the viewer says: {self.app.message}" if self.app.message else ""
                raise HeadlessError(f"waited {timeout_s:.0f} s in vain for {what}{said}")
            self._watch()
            self.app.desk.connection.mailbox.wait(IDLE_S)

    def paint(self, quality: Callable[[RenderOptions], RenderOptions] | None = None) -> None:
        """Draw the picture as it is now; `quality` as for `Stage.paint_to`."""
        self.stage.paint_to(self._target, self.size, quality)
        self._painted_at = time.monotonic()
        self._is_stale = False
        if self.first_picture_at is None and self.app.feed.pair is not None:
            self.stage.pixels(self._target, self.size)  # drawing is done only once it can be read
            self.first_picture_at = time.monotonic()

    def pixels(self) -> npt.NDArray[np.uint8]:
        """Return the picture drawn last, [height, width, 3], first row on top."""
        return self.stage.pixels(self._target, self.size)

    def picture(self, name: str) -> npt.NDArray[np.uint8]:
        """Wait until water and camera stand, draw, write the picture `name` and return it."""
        self.pump(lambda: self.app.is_settled, "the picture to settle", SETTLE_TIMEOUT_S, float("inf"))
        self.paint(still)
        pixels = self.pixels()
        save_png(self.folder / name, pixels)
        self.pictures.append(name)
        return pixels

    def follow(self, steps: list[ScriptStep], timeout_s: float = 600.0) -> None:
        """Carry out a script.

        Raises:
            HeadlessError: a step's moment did not come.
            ViewerError: a command could not be carried out.
        """
        app = self.app
        self.pump(lambda: app.shown is not None, "the terrain", timeout_s)
        begun = time.monotonic()
        for number, step in enumerate(steps, 1):
            if step.at_wall is not None:
                due = begun + step.at_wall
                self.pump(lambda due=due: time.monotonic() >= due, f"step {number}", timeout_s)  # type: ignore[misc]
            if step.until_time is not None:
                self.wait_computed(step.until_time, timeout_s)
            if step.command is not None:
                app.carry_out(step.command)
                self.pump(lambda: not app.is_busy, f"the answer to step {number}", timeout_s)
            if step.picture is not None:
                self.picture(step.picture)

    def wait_computed(self, until_time: float, timeout_s: float) -> None:
        """Wait until the shown run is computed and at hand to `until_time` [s], or to its end."""
        app = self.app

        def is_there() -> bool:
            shown = app.shown
            if shown is None or shown.info.status == "failed":
                return shown is not None
            target = min(until_time, shown.info.duration)
            return shown.timeline.last_time >= target - 1e-6 * max(1.0, target)

        self.pump(is_there, f"the run to reach {until_time:.0f} s", timeout_s)
        if app.shown is not None and app.shown.info.status == "failed":
            raise HeadlessError(f"the run failed: {app.shown.info.message}")

    def close(self) -> None:
        """Release what was made on the context, and the context."""
        context = self.stage.context
        self._target.release()
        self._colour.release()
        self.stage.close()
        context.release()
