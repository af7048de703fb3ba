import moderngl
import numpy as np
import pytest

from viewer.render.present_pass import PresentPass

pytestmark = pytest.mark.gl


def test_the_scene_arrives_pixel_for_pixel(ctx: moderngl.Context, rng: np.random.Generator) -> None:
    pixels = rng.integers(0, 256, (20, 30, 4), dtype=np.uint8)
    scene, target = ctx.texture((30, 20), 4, pixels), ctx.simple_framebuffer((30, 20))
    present = PresentPass(ctx)

    assert present.draw(target, (30, 20), scene) == 1
    drawn = np.frombuffer(target.read(components=3, alignment=1), dtype=np.uint8).reshape(20, 30, 3)
    assert np.array_equal(drawn, pixels[..., :3])
    ctx.detect_framebuffer(0).use()
    for thing in (present, scene, target):
        thing.release()


def test_an_outdated_scene_arrives_greyed_and_colours_come_back(
    ctx: moderngl.Context, rng: np.random.Generator
) -> None:
    pixels = rng.integers(0, 256, (20, 30, 4), dtype=np.uint8)
    scene, target = ctx.texture((30, 20), 4, pixels), ctx.simple_framebuffer((30, 20))
    present = PresentPass(ctx)

    present.draw(target, (30, 20), scene, is_outdated=True)
    faded = np.frombuffer(target.read(components=3, alignment=1), dtype=np.uint8).reshape(20, 30, 3)
    luminance = pixels[..., :3] @ np.array([0.2126, 0.7152, 0.0722])
    expected = 0.12 * 255.0 + 0.76 * (0.7 * luminance[..., None] + 0.3 * pixels[..., :3])
    np.testing.assert_allclose(faded, expected, atol=1.0)
    present.draw(target, (30, 20), scene)
    coloured = np.frombuffer(target.read(components=3, alignment=1), dtype=np.uint8).reshape(20, 30, 3)
    assert np.array_equal(coloured, pixels[..., :3])
    ctx.detect_framebuffer(0).use()
    for thing in (present, scene, target):
        thing.release()
