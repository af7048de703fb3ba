"""Pictures that are kept, and the same pictures in a context of a given version.

Kept pictures are made by Mesa's llvmpipe on the image that tests run on. One that has no file yet gets one by

    python -m tests.viewer.render.golden_views

and a file that is there is never written again; who means to change one deletes it first, and looks at it.
With `--digests` nothing is written: the version of the context and a digest of each picture are printed.
"""

import hashlib
import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import moderngl
import numpy as np
from PIL import Image

from protocol import GridGeometry
from tests.viewer.conftest import hills
from viewer.lod import Border
from viewer.render import (
    DrapedLine,
    EditOverlay,
    FrameInputs,
    HudText,
    LineStyle,
    Renderer,
    RenderOptions,
    WaterFrame,
    WaterPair,
    create_headless_context,
)
from viewer.world import Camera, Heightfield, overview

FOLDER = Path(__file__).parent / "golden"
SIZE = (320, 200)
SHAPE, DX = (180, 240), 10.0

Change = Callable[[Heightfield, RenderOptions], RenderOptions]


def ground() -> Heightfield:
    grid = GridGeometry(nrows=SHAPE[0], ncols=SHAPE[1], dx=DX, x0=1000.0, y0=5000.0)
    outside = np.zeros(SHAPE, np.bool_)
    outside[150:, 200:] = True
    z = hills(*SHAPE, DX, 80.0)
    return Heightfield(grid, np.where(outside, np.float32(300.0), z), outside)


def lake(field: Heightfield) -> WaterPair:
    frames = [
        WaterFrame(level, np.where(field.drawn < level, level - field.drawn, 0.0).astype(np.float32))
        for level in (-20.0, -14.0)
    ]
    return WaterPair(frames[0], frames[1], 0.4)


def photograph(field: Heightfield) -> np.ndarray:
    rows, cols = np.mgrid[0 : SHAPE[0], 0 : SHAPE[1]]
    fields = ((rows // 18 + cols // 24) % 3)[..., None]
    colours = np.array([[96, 120, 60], [150, 140, 90], [70, 95, 50]], np.uint8)
    return colours[fields[..., 0]]


def scenes(field: Heightfield) -> Iterator[tuple[str, FrameInputs]]:
    whole = overview(SHAPE[1] * DX, SHAPE[0] * DX, 0.0, aspect=SIZE[0] / SIZE[1])
    near = Camera((100.0, 0.0, 60.0), 420.0, 0.7, math.radians(24.0))
    sign = np.zeros(SHAPE, np.int8)
    sign[88:92, 90:150] = 1
    line = DrapedLine(((1950.0, 5900.0), (2450.0, 5900.0)), 40.0, LineStyle.RAISE)
    edits = EditOverlay(1, sign, (line,))
    hud = HudText("A flood", "00:10:00", is_hypothetical=True)
    contours = RenderOptions(contour_interval=10.0)
    yield "cartographic", FrameInputs(whole, options=contours, hud=hud)
    yield "flood", FrameInputs(near, lake(field), edits, contours, hud)
    low_sun = RenderOptions(light_azimuth_deg=250.0, light_elevation_deg=12.0)
    yield "evening", FrameInputs(whole, options=low_sun)
    blocks = RenderOptions(show_blocks=True, border=Border.PAD)
    yield "blocks", FrameInputs(whole, lake(field), options=blocks)
    field.cover(field.outside, photograph(field))
    yield "imagery", FrameInputs(whole, lake(field), options=RenderOptions(exaggeration=1.5))


def pictures(
    ctx: moderngl.Context, change: Change = lambda field, options: options
) -> Iterator[tuple[str, np.ndarray]]:
    """Each picture by name; `change` makes a wrong ground or wrong options of the right ones."""
    framebuffer = ctx.simple_framebuffer(SIZE)
    field = ground()
    renderer, covered = Renderer(ctx, field), field.cover_revision
    for name, inputs in scenes(field):
        options = change(field, inputs.options)
        if field.cover_revision != covered:
            framebuffer.use()
            renderer.release()
            renderer, covered = Renderer(ctx, field), field.cover_revision
        renderer.draw(framebuffer, SIZE, replace(inputs, options=options))
        yield name, renderer.read_pixels(framebuffer, SIZE)
    ctx.detect_framebuffer(0).use()
    renderer.release()
    framebuffer.release()


def digest(picture: np.ndarray) -> str:
    return hashlib.sha256(picture.tobytes()).hexdigest()


def main() -> None:
    ctx = create_headless_context()
    if "--digests" in sys.argv:
        print(ctx.version_code)
    for name, picture in pictures(ctx):
        path = FOLDER / f"{name}.png"
        if "--digests" in sys.argv:
            print(name, digest(picture))
        elif not path.exists():
            FOLDER.mkdir(exist_ok=True)
            Image.fromarray(picture).save(path, optimize=True)


if __name__ == "__main__":
    main()
