"""Pictures equal the ones that are kept, and are the same in a context of OpenGL 4.1.

All tests marked `gl` can be run so, too:

    MESA_GL_VERSION_OVERRIDE=4.1 MESA_GLSL_VERSION_OVERRIDE=410 python -m pytest -m gl
"""

import dataclasses
import os
import subprocess
import sys

import moderngl
import numpy as np
import pytest
from PIL import Image

from tests.viewer.render.golden_views import FOLDER, Change, digest, pictures
from viewer.app.picture_quality import is_software
from viewer.render import RenderOptions
from viewer.world import Heightfield

pytestmark = pytest.mark.gl

STEP = 12
"""Levels of a channel by which a pixel may differ before it counts as another one."""
SHARE = 0.002
"""Share of pixels that may be others: rasterisers round the edges of triangles in their own way."""


def other_pixels(first: np.ndarray, second: np.ndarray) -> float:
    return float((np.abs(first.astype(int) - second).max(axis=2) > STEP).mean())


def kept() -> dict[str, np.ndarray]:
    pictures_kept = {}
    for path in sorted(FOLDER.glob("*.png")):
        with Image.open(path) as picture:
            pictures_kept[path.stem] = np.asarray(picture)
    return pictures_kept


@pytest.fixture(scope="module")
def software(ctx: moderngl.Context) -> moderngl.Context:
    if not is_software(ctx):
        pytest.skip("pictures are kept for Mesa's software renderer")
    return ctx


@pytest.fixture(scope="module")
def drawn(software: moderngl.Context) -> dict[str, np.ndarray]:
    return dict(pictures(software))


def test_pictures_are_those_that_are_kept(drawn: dict[str, np.ndarray]) -> None:
    found = {name: other_pixels(picture, drawn[name]) for name, picture in kept().items()}

    assert set(drawn) == set(found)
    assert max(found.values()) <= SHARE, found


def raised(field: Heightfield, options: RenderOptions) -> RenderOptions:
    """The ground a metre too high."""
    if field.revision == 0:
        field.set(field.z_b + np.float32(1.0))
    return options


def other_sun(field: Heightfield, options: RenderOptions) -> RenderOptions:
    return dataclasses.replace(options, light_azimuth_deg=options.light_azimuth_deg - 40.0)


@pytest.mark.parametrize(("wrong", "picture"), [(raised, "flood"), (other_sun, "evening")])
def test_a_wrong_ground_or_light_is_another_picture(
    software: moderngl.Context, wrong: Change, picture: str
) -> None:
    mutant = dict(pictures(software, wrong))[picture]

    assert other_pixels(mutant, kept()[picture]) > 10 * SHARE


def test_pictures_are_the_same_where_there_is_nothing_above_opengl_4_1(drawn: dict[str, np.ndarray]) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tests.viewer.render.golden_views", "--digests"],
        env={**os.environ, "MESA_GL_VERSION_OVERRIDE": "4.1", "MESA_GLSL_VERSION_OVERRIDE": "410"},
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    version, *digests = done.stdout.split("\n")[:-1]

    assert version == "410"
    assert digests == [f"{name} {digest(picture)}" for name, picture in drawn.items()]
