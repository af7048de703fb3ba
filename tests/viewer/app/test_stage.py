"""The stage draws whatever scene it is given into whatever framebuffer it is given."""

from pathlib import Path

import moderngl
import numpy as np
import pytest
from PIL import Image

from tests.viewer.tiny_service import GRID, valley
from viewer.app.camera_work import CameraWork
from viewer.app.stage import EMPTY_COLOUR, Stage
from viewer.commands import SavePicture
from viewer.errors import ContextError
from viewer.render import FrameInputs
from viewer.world import Heightfield

SIZE = (160, 90)


class StillScene:
    """A scene without a flood."""

    def __init__(self) -> None:
        self.heightfield: Heightfield | None = None
        self.painted: list[tuple[int, int]] = []
        self.order: SavePicture | None = None
        self.said: list[str] = []

    def frame_inputs(self) -> FrameInputs | None:
        return None if self.heightfield is None else FrameInputs(CameraWork(self.heightfield).camera)

    def note_painted(self, size: tuple[int, int]) -> None:
        self.painted.append(size)

    def take_picture_order(self) -> SavePicture | None:
        order, self.order = self.order, None
        return order

    def complain(self, sentence: str) -> None:
        self.said.append(sentence)


def staged(ctx: moderngl.Context) -> tuple[Stage, StillScene, moderngl.Framebuffer]:
    scene = StillScene()
    stage = Stage(scene, lambda: ctx)
    stage.open()
    return stage, scene, ctx.framebuffer([ctx.texture(SIZE, 3)])


def test_before_the_terrain_comes_the_picture_is_empty(ctx: moderngl.Context) -> None:
    stage, scene, target = staged(ctx)
    stage.paint_to(target, SIZE)

    expected = np.round(255 * np.array(EMPTY_COLOUR[:3]))
    np.testing.assert_allclose(stage.pixels(target, SIZE), np.broadcast_to(expected, (90, 160, 3)), atol=1)
    assert scene.painted == []
    assert stage.ground_at(80, 45) is None


def test_a_terrain_is_drawn_and_can_be_picked(ctx: moderngl.Context) -> None:
    stage, scene, target = staged(ctx)
    scene.heightfield = Heightfield(GRID, valley())
    stage.paint_to(target, SIZE)
    place = stage.ground_at(80, 50)

    assert scene.painted == [SIZE]
    assert len(np.unique(stage.pixels(target, SIZE).reshape(-1, 3), axis=0)) > 100
    assert place is not None
    assert GRID.contains(*place)
    assert stage.ground_at(2, 2) is None
    stage.close()


def test_another_terrain_gets_another_renderer(ctx: moderngl.Context) -> None:
    stage, scene, target = staged(ctx)
    scene.heightfield = Heightfield(GRID, valley())
    stage.paint_to(target, SIZE)
    first = stage.pixels(target, SIZE)
    scene.heightfield = Heightfield(GRID, np.flipud(valley() ** 1.3))
    stage.paint_to(target, SIZE)

    assert (first != stage.pixels(target, SIZE)).any()
    stage.close()


def test_a_wanted_picture_is_written_once_as_it_is_seen(ctx: moderngl.Context, tmp_path: Path) -> None:
    stage, scene, target = staged(ctx)
    scene.heightfield = Heightfield(GRID, valley())
    scene.order = SavePicture(str(tmp_path / "a.png"))
    stage.paint_to(target, SIZE)
    with Image.open(tmp_path / "a.png") as written:
        difference = np.abs(np.asarray(written, np.int16) - stage.pixels(target, SIZE))
    assert difference.mean() < 3.0  # the file has smooth edges
    assert (difference.max(axis=2) > 60).mean() < 0.02
    assert "160 x 90 pixels written" in scene.said[0]
    stage.paint_to(target, SIZE)

    assert len(scene.said) == 1
    stage.close()


def test_a_picture_of_another_size_leaves_the_one_on_the_screen_alone(
    ctx: moderngl.Context, tmp_path: Path
) -> None:
    stage, scene, target = staged(ctx)
    scene.heightfield = Heightfield(GRID, valley())
    stage.paint_to(target, SIZE)
    before, place = stage.pixels(target, SIZE), stage.ground_at(80, 60)
    scene.order = SavePicture(str(tmp_path / "a.png"), 640.0, 360.0, with_text=False)
    stage.paint_to(target, SIZE)
    with Image.open(tmp_path / "a.png") as written:
        assert written.size == (640, 360)
        small = np.asarray(written.resize(SIZE, Image.Resampling.BOX), np.int16)

    assert np.abs(small - before).mean() < 6.0
    np.testing.assert_array_equal(stage.pixels(target, SIZE), before)
    assert stage.ground_at(80, 60) == place
    stage.close()


def test_a_picture_that_cannot_be_written_is_told(ctx: moderngl.Context, tmp_path: Path) -> None:
    stage, scene, target = staged(ctx)
    scene.heightfield = Heightfield(GRID, valley())
    scene.order = SavePicture(str(tmp_path / "no-such-folder" / "a.png"))
    stage.paint_to(target, SIZE)

    assert "could not be written" in scene.said[0]
    stage.close()


def test_a_context_that_is_too_old_is_refused() -> None:
    class OldContext:
        version_code = 330
        info = {"GL_RENDERER": "an old chip"}  # noqa: RUF012

    with pytest.raises(ContextError, match=r"OpenGL 4\.1 is needed"):
        Stage(StillScene(), OldContext).open()  # type: ignore[arg-type]
