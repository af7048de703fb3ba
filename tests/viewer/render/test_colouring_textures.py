"""Classes on the picture: each pixel has the colour of the class that the probe reads in its cell."""

import math
from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from tests.viewer.render.views import BARE
from viewer.errors import TerrainDataError
from viewer.render import CellField, Colouring, FrameInputs, RenderOptions, WaterFrame, WaterPair
from viewer.render.colouring_textures import ColouringTextures
from viewer.world import Camera, ClassScale, Heightfield, WaterColour, hazard_rating, water_scale

pytestmark = pytest.mark.gl

ABOVE = Camera((0.0, 0.0, 0.0), 700.0, 0.0, math.pi / 2)
STEEP = Camera((60.0, 0.0, 30.0), 500.0, 0.7, math.radians(50.0))


def steps(shape: tuple[int, int], limits: tuple[float, ...], seed: int) -> np.ndarray:
    """Random values of which many lie exactly at a limit, or one float below it."""
    rng = np.random.default_rng(seed)
    at = np.asarray(limits, np.float32)
    below = np.nextafter(at, np.float32(0.0))
    choices = np.concatenate([at, below, rng.uniform(0.02, 1.5 * at[-1], 12).astype(np.float32)])
    return rng.choice(choices, shape).astype(np.float32)


def shown_classes(picture: np.ndarray, scale: ClassScale) -> np.ndarray:
    """The class whose colour is nearest at each pixel, [height, width]."""
    distance = np.linalg.norm(picture[:, :, None, :].astype(float) - np.array(scale.colours), axis=-1)
    return distance.argmin(axis=-1)


def probed_cells(stage: object, field: Heightfield) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Row and column of the cell at each pixel, and which pixels lie well inside of it; top row first."""
    depth, back = stage.renderer.read_depth()  # type: ignore[attr-defined]
    rows, cols = np.mgrid[: depth.shape[0], : depth.shape[1]]
    world = back.world(cols, rows, depth)
    row, col = field.grid.to_cell(world[..., 0] + field.frame.x_centre, field.frame.y_centre - world[..., 2])
    r, c = np.rint(row).astype(int)[::-1], np.rint(col).astype(int)[::-1]
    inside = (np.abs(row[::-1] - r) < 0.47) & (np.abs(col[::-1] - c) < 0.47)
    return r, c, inside


def disagreeing(stage: object, field: Heightfield, inputs: FrameInputs, classes: np.ndarray) -> float:
    """Share of pixels whose colour tells another class than `classes` has in their cell."""
    assert inputs.colouring is not None
    picture = stage.draw(inputs)  # type: ignore[attr-defined]
    r, c, inside = probed_cells(stage, field)
    shown = shown_classes(picture, inputs.colouring.scale)
    return float((shown != classes[r, c])[inside].mean())


@pytest.mark.parametrize("camera", [ABOVE, STEEP])
@pytest.mark.parametrize("colour", [WaterColour.DEPTH, WaterColour.SPEED, WaterColour.HAZARD])
def test_what_the_colour_shows_is_what_the_cell_holds_also_at_the_limits(
    make_heightfield: Callable, make_stage: Callable, colour: WaterColour, camera: Camera
) -> None:
    field = make_heightfield(height=4.0)
    stage = make_stage(field, (300, 200))
    scale = water_scale(colour, 3600.0)
    assert scale is not None
    by_depth = water_scale(WaterColour.DEPTH, 1.0)
    assert by_depth is not None
    h = steps(field.z_b.shape, by_depth.limits, 1)
    speed = steps(field.z_b.shape, (0.25, 0.5, 1.0, 2.0, 3.0, 5.0), 2)
    values = {WaterColour.DEPTH: h, WaterColour.SPEED: speed, WaterColour.HAZARD: hazard_rating(h, speed)}
    fields = () if colour is WaterColour.DEPTH else (CellField("v", speed), CellField("v", speed))
    frame = WaterFrame("w", h)

    def share(shift: float) -> float:

        inputs = FrameInputs(
            camera,
            WaterPair(frame, frame),
            options=RenderOptions(**BARE),
            colouring=Colouring(colour, scale, fields),
        )
        expected = scale.class_of(values[colour] * np.float32(1.0 + shift))
        return disagreeing(stage, field, inputs, expected)

    assert share(0.0) == 0.0
    assert share(-2e-6) > 0.005  # what is a hair below the limits must be told apart


def test_a_film_too_thin_to_be_shown_has_no_class(make_heightfield: Callable, make_stage: Callable) -> None:
    stage = make_stage(make_heightfield(height=4.0), (300, 200))
    scale = water_scale(WaterColour.DEPTH, 1.0)
    assert scale is not None

    def draw(depth: float, colouring: Colouring | None) -> np.ndarray:
        frame = WaterFrame(depth, np.full((257, 321), depth, np.float32))
        options = RenderOptions(depth_shown=0.01, **BARE)
        return stage.draw(FrameInputs(ABOVE, WaterPair(frame, frame), options=options, colouring=colouring))

    colouring = Colouring(WaterColour.DEPTH, scale)
    assert np.array_equal(draw(0.009, None), draw(0.009, colouring))
    assert not np.array_equal(draw(0.011, None), draw(0.011, colouring))


def test_between_two_frames_depth_and_speed_are_blended(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    field = make_heightfield(height=4.0)
    stage = make_stage(field, (300, 200))
    scale = water_scale(WaterColour.SPEED, 1.0)
    assert scale is not None
    rng = np.random.default_rng(3)
    h = np.full(field.z_b.shape, 2.0, np.float32)
    first, second = (rng.uniform(0.0, 6.0, h.shape).astype(np.float32) for _ in range(2))
    pair = WaterPair(WaterFrame("a", h), WaterFrame("b", h), 0.25)
    colouring = Colouring(WaterColour.SPEED, scale, (CellField("a", first), CellField("b", second)))
    inputs = FrameInputs(ABOVE, pair, options=RenderOptions(**BARE), colouring=colouring)

    assert disagreeing(stage, field, inputs, scale.class_of(0.75 * first + 0.25 * second)) < 1e-4
    assert disagreeing(stage, field, inputs, scale.class_of(first)) > 0.1


def test_a_field_of_the_whole_run_colours_dry_ground_and_leaves_alone_what_was_never_wet(
    make_heightfield: Callable, make_stage: Callable
) -> None:
    field = make_heightfield(height=4.0)
    stage = make_stage(field, (300, 200))
    scale = water_scale(WaterColour.ARRIVAL, 3500.0)
    assert scale is not None
    times = np.full(field.z_b.shape, -1.0, np.float32)
    times[:, 160:] = 700.0
    h = np.zeros(field.z_b.shape, np.float32)
    h[100:130, :] = 1.0
    frame = WaterFrame("w", h)

    def draw(colouring: Colouring | None) -> np.ndarray:
        options = RenderOptions(**BARE)
        inputs = FrameInputs(ABOVE, WaterPair(frame, frame), options=options, colouring=colouring)
        return stage.draw(inputs).astype(int)

    plain, coloured = draw(None), draw(Colouring(WaterColour.ARRIVAL, scale, (CellField("t", times),)))
    row, col, _ = probed_cells(stage, field)
    never, reached = col < 158, col > 162

    assert np.array_equal(plain[never], coloured[never])
    assert (shown_classes(coloured, scale)[reached] == 1).mean() > 0.99
    assert (h[row, col][reached] > 0.0).any()
    assert (h[row, col][reached] == 0.0).any()


def test_it_uploads_what_is_new_and_refuses_another_shape(ctx: moderngl.Context) -> None:
    textures = ColouringTextures(ctx, (5, 7))
    scale = water_scale(WaterColour.SPEED, 1.0)
    assert scale is not None
    values = np.arange(35, dtype=np.float32).reshape(5, 7)
    a, b, c = (CellField(name, values + k) for k, name in enumerate("abc"))
    for first, second in ((a, b), (b, c), (c, c)):
        textures.follow(Colouring(WaterColour.SPEED, scale, (first, second)))
        for slot, field in zip(textures._bound, (first, second), strict=True):
            assert slot.key == field.key
            read = np.frombuffer(slot.texture.read(), "f4").reshape(5, 7)
            assert np.array_equal(read, field.values)

    with pytest.raises(TerrainDataError, match=r"shape \(4, 7\)"):
        textures.follow(Colouring(WaterColour.SPEED, scale, (CellField("d", values[:4]),)))
    textures.release()
