"""A hilly terrain, an OpenGL context without a window, and a stage on which pictures are taken."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import moderngl
import numpy as np
import pytest

from protocol import GridGeometry
from viewer.render import FrameInputs, FrameStats, Renderer, create_headless_context
from viewer.world import Heightfield


def hills(nrows: int, ncols: int, dx: float, height: float, seed: int = 7) -> np.ndarray:
    """Smooth random hills with detail down to a few cells, float32 [nrows, ncols]."""
    rng = np.random.default_rng(seed)
    y, x = np.meshgrid(np.arange(nrows) * dx, np.arange(ncols) * dx, indexing="ij")
    z = np.zeros((nrows, ncols))
    for _ in range(60):
        length = dx * 4.0 * 2.0 ** rng.uniform(0.0, 5.0)
        bearing, phase = rng.uniform(0.0, 2.0 * np.pi, 2)
        wave = np.sin(2.0 * np.pi * (x * np.cos(bearing) + y * np.sin(bearing)) / length + phase)
        z += wave * length / (dx * 128.0)
    return (height * z / np.abs(z).max()).astype(np.float32)


@pytest.fixture(scope="session")
def make_heightfield() -> Callable[..., Heightfield]:
    def make(nrows: int = 257, ncols: int = 321, dx: float = 10.0, height: float = 120.0) -> Heightfield:
        grid = GridGeometry(nrows=nrows, ncols=ncols, dx=dx, x0=1000.0, y0=5000.0)
        return Heightfield(grid, hills(nrows, ncols, dx, height))

    return make


@pytest.fixture
def hilly(make_heightfield: Callable[..., Heightfield]) -> Heightfield:
    return make_heightfield()


@pytest.fixture(scope="session")
def ctx() -> Iterator[moderngl.Context]:
    context = create_headless_context()
    yield context
    context.release()


@dataclass
class Stage:
    """A renderer and a framebuffer to look at."""

    renderer: Renderer
    framebuffer: moderngl.Framebuffer
    size: tuple[int, int]
    stats: FrameStats | None = None

    def draw(self, inputs: FrameInputs) -> np.ndarray:
        """The picture, [height, width, 3], first row on top."""
        self.stats = self.renderer.draw(self.framebuffer, self.size, inputs)
        return self.renderer.read_pixels(self.framebuffer, self.size)


@pytest.fixture
def make_stage(ctx: moderngl.Context) -> Iterator[Callable[..., Stage]]:
    stages: list[Stage] = []

    def make(heightfield: Heightfield, size: tuple[int, int] = (480, 300)) -> Stage:
        renderer = Renderer(ctx, heightfield)
        stages.append(Stage(renderer, ctx.simple_framebuffer(size), size))
        return stages[-1]

    assert ctx.error == "GL_NO_ERROR"
    yield make
    assert ctx.error == "GL_NO_ERROR"
    # moderngl goes back to the framebuffer bound last, which must therefore outlive the ones released here.
    ctx.detect_framebuffer(0).use()
    for stage in stages:
        stage.renderer.release()
        stage.framebuffer.release()
