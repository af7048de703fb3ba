"""The depth difference between two runs on the graphics card, one byte a cell."""

from __future__ import annotations

import moderngl
import numpy as np
import numpy.typing as npt

from viewer.errors import TerrainDataError
from viewer.render.frame_inputs import DepthDifference
from viewer.render.shader_library import set_uniforms

__all__ = ["DIFFERENCE_RANGE_M", "DifferenceTexture", "packed_difference"]

DIFFERENCE_RANGE_M = 2.0
"""Differences beyond this look alike [m]."""
_UNIT = 12
"""Texture unit after those of ground and water."""


def packed_difference(metres: npt.NDArray[np.float32]) -> npt.NDArray[np.uint8]:
    """128 for no difference, 1 and 255 for the whole range, shape as given."""
    scaled = np.clip(np.rint(metres * np.float32(127.0 / DIFFERENCE_RANGE_M)), -127, 127)
    return np.asarray(scaled + 128, np.uint8)


class DifferenceTexture:
    """Follows the difference of the frame inputs; holds a single cell while there is none."""

    def __init__(self, ctx: moderngl.Context, shape: tuple[int, int]) -> None:
        """Begin without a difference.

        Args:
            ctx: the OpenGL context.
            shape: rows and columns of the terrain.
        """
        self._ctx = ctx
        self._shape = shape
        self._texture = ctx.texture((1, 1), 1, b"\x80", alignment=1)
        self._shown: DepthDifference | None = None

    def follow(self, difference: DepthDifference | None) -> None:
        """Upload a difference that is new.

        Raises:
            TerrainDataError: it does not fit the terrain.
        """
        if difference is not None and (self._shown is None or difference.key != self._shown.key):
            if difference.metres.shape != self._shape:
                raise TerrainDataError(
                    f"depth difference has shape {difference.metres.shape}, the terrain has {self._shape}"
                )
            size = (self._shape[1], self._shape[0])
            if self._texture.size != size:
                self._texture.release()
                self._texture = self._ctx.texture(size, 1, alignment=1)
                self._texture.repeat_x = self._texture.repeat_y = False
            self._texture.write(packed_difference(difference.metres), alignment=1)
        self._shown = difference

    def bind(self, program: moderngl.Program) -> None:
        """Bind what `shaders/common/difference.glsl` asks for."""
        self._texture.use(_UNIT)
        set_uniforms(
            program,
            difference=_UNIT,
            difference_range=DIFFERENCE_RANGE_M,
            has_difference=int(self._shown is not None),
        )

    def release(self) -> None:
        """Give the memory back."""
        self._texture.release()
