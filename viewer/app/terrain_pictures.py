"""The pictures of a terrain that come from the service: unpacked within limits and laid on the ground."""

from __future__ import annotations

import io

import numpy as np
import numpy.typing as npt
from PIL import Image

import protocol
from viewer.errors import TerrainDataError
from viewer.world import Heightfield

__all__ = ["TerrainPictures", "decode_imagery", "decode_walls"]


class TerrainPictures:
    """What has come of the pictures of one run's terrain, before and after the terrain itself.

    Args:
        run: the run whose pictures were asked for.
    """

    def __init__(self, run: str) -> None:
        self.run = run
        self._ground: Heightfield | None = None
        self._walls: npt.NDArray[np.bool_] | None = None
        self._imagery: npt.NDArray[np.uint8] | None = None

    def take(self, message: protocol.ImageryReceived, shape: tuple[int, int]) -> None:
        """Unpack a picture and lay it on the ground, if that is there.

        Args:
            message: the picture.
            shape: rows and columns of the grid.

        Raises:
            TerrainDataError: it is no such picture, or does not fit.
        """
        if message.layer == "walls":
            self._walls = decode_walls(message.data, shape)
        else:
            self._imagery = decode_imagery(message.data)
        self._lay()

    def lay_on(self, ground: Heightfield) -> None:
        """Lay what has come on a ground, and all that comes later."""
        self._ground = ground
        self._lay()

    def _lay(self) -> None:
        if self._ground is not None and (self._walls is not None or self._imagery is not None):
            self._ground.cover(self._walls, self._imagery)


def decode_imagery(data: bytes) -> npt.NDArray[np.uint8]:
    """A colour picture of the ground, [rows, cols, 3], row 0 in the south.

    Raises:
        TerrainDataError: the bytes are no JPEG within the limits of the protocol.
    """
    side = protocol.limits.MAX_IMAGERY_SIDE
    return np.ascontiguousarray(_unpacked(data, "JPEG", "RGB", (side, side))[::-1])


def decode_walls(data: bytes, shape: tuple[int, int]) -> npt.NDArray[np.bool_]:
    """Cells without data, row 0 in the south.

    Args:
        data: the bytes of a PNG.
        shape: rows and columns that it must have.

    Raises:
        TerrainDataError: the bytes are no PNG of that size.
    """
    pixels = _unpacked(data, "PNG", "L", (shape[1], shape[0]))
    if pixels.shape != shape:
        raise TerrainDataError(f"the picture of cells without data has {pixels.shape} pixels, not {shape}")
    return np.ascontiguousarray(pixels[::-1] > 127)


def _unpacked(data: bytes, form: str, mode: str, largest: tuple[int, int]) -> npt.NDArray[np.uint8]:
    try:
        with Image.open(io.BytesIO(data), formats=[form]) as picture:
            # The head tells the size; no pixel is unpacked before it is known to be allowed.
            if picture.width > largest[0] or picture.height > largest[1]:
                raise TerrainDataError(
                    f"a picture of the terrain has {picture.width} x {picture.height} pixels; "
                    f"up to {largest[0]} x {largest[1]} are allowed"
                )
            return np.asarray(picture.convert(mode), dtype=np.uint8)
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise TerrainDataError(f"a picture of the terrain cannot be read as {form}: {error}") from error
