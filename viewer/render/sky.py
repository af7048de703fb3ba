"""A sky made of numbers.

A cube map with sun, haze and clouds, drawn behind everything and mirrored in the water.
"""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.render.frame_uniforms import HORIZON
from viewer.render.shader_library import build_program, set_uniforms

__all__ = ["SkyPass", "sky_faces"]

_SIDE = 256
_ZENITH = np.array([0.24, 0.45, 0.76])
_BELOW = np.array([0.47, 0.53, 0.59])
_SEED = 1959


def sky_faces(sun: tuple[float, float, float], side: int = _SIDE) -> npt.NDArray[np.uint8]:
    """The six faces of the sky in the order of OpenGL (+x -x +y -y +z -z), shape [6, side, side, 3].

    Args:
        sun: unit vector to the sun, world axes.
        side: pixels along a face.
    """
    at = (np.arange(side) + 0.5) / side * 2.0 - 1.0
    t, s = np.meshgrid(at, at, indexing="ij")
    one = np.ones_like(s)
    axes = [(one, -t, -s), (-one, -t, s), (s, one, t), (s, -one, -t), (s, -t, one), (-s, -t, -one)]
    faces = []
    for x, y, z in axes:
        direction = np.stack([x, y, z], axis=-1)
        direction /= np.linalg.norm(direction, axis=-1, keepdims=True)
        faces.append(_colour(direction, np.asarray(sun)))
    return (np.clip(np.stack(faces), 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def _colour(direction: npt.NDArray[np.float64], sun: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    up = direction[..., 1:2]
    height = np.clip(up, 0.0, 1.0)
    colour = np.array(HORIZON) + (_ZENITH - np.array(HORIZON)) * (1.0 - (1.0 - height) ** 2.6)
    toward = np.clip(direction @ sun, 0.0, 1.0)[..., None]
    colour = colour + np.array([0.30, 0.24, 0.12]) * toward**10 + np.array([0.9, 0.85, 0.7]) * toward**900

    # Clouds lie on a plane overhead; near the horizon they thin out into haze.
    plane = direction[..., 0::2] / np.maximum(up, 0.05)
    cover = np.clip((_cloud_noise(plane * 1.1) - 0.50) * 3.2, 0.0, 1.0)[..., None]
    cover = cover * np.clip((up - 0.04) * 5.0, 0.0, 1.0) * 0.75
    colour = colour + cover * (np.array([0.97, 0.97, 0.98]) - colour)

    # Below the horizon there is no map: a plain haze that darkens downward.
    depth = np.clip(-up, 0.0, 1.0)
    below = np.array(HORIZON) + (_BELOW - np.array(HORIZON)) * (1.0 - (1.0 - depth) ** 3.0)
    return np.where(up >= 0.0, colour, below)


def _cloud_noise(plane: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Five octaves of value noise, 0 to 1."""
    lattice = np.random.default_rng(_SEED).random((64, 64))
    total = np.zeros(plane.shape[:-1])
    weight = 0.5
    for octave in range(5):
        p = plane * 2.0**octave + 17.3 * octave
        cell = np.floor(p).astype(np.int64)
        f = p - cell
        f = f * f * (3.0 - 2.0 * f)
        i, j = cell[..., 0] % 64, cell[..., 1] % 64
        i1, j1 = (i + 1) % 64, (j + 1) % 64
        low = lattice[i, j] * (1.0 - f[..., 0]) + lattice[i1, j] * f[..., 0]
        high = lattice[i, j1] * (1.0 - f[..., 0]) + lattice[i1, j1] * f[..., 0]
        total += weight * (low * (1.0 - f[..., 1]) + high * f[..., 1])
        weight *= 0.5
    return total


class SkyPass:
    """The sky behind the scene, and the texture that water mirrors."""

    def __init__(self, ctx: moderngl.Context) -> None:
        """Compile; the sky itself is made when the sun is known."""
        self._ctx = ctx
        self._program = build_program(ctx, "full_screen.vert", "sky.frag")
        set_uniforms(self._program, sky=0, far_plane=1.0)
        self._array = ctx.vertex_array(self._program, [])
        self._sun: tuple[float, float, float] | None = None
        self.texture = ctx.texture_cube((_SIDE, _SIDE), 3)

    def follow(self, sun: tuple[float, float, float]) -> None:
        """Make the sky anew if the sun moved."""
        if sun == self._sun:
            return
        for face, pixels in enumerate(sky_faces(sun)):
            self.texture.write(face, np.ascontiguousarray(pixels), alignment=1)
        self.texture.build_mipmaps()
        self.texture.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        self._sun = sun

    def draw(self, direction_of_place: npt.NDArray[np.float64]) -> int:
        """Fill the picture with sky, and return the number of draws.

        Args:
            direction_of_place: inverse of projection times rotation of the view, shape [4, 4].
        """
        # Last of the scene and behind all of it, so that only what is still open is filled.
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<="
        self.texture.use(0)
        set_uniforms(self._program, direction_of_place=tuple(direction_of_place.T.ravel().tolist()))
        self._array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def release(self) -> None:
        """Give the memory back."""
        for thing in (self._array, self._program, self.texture):
            thing.release()
