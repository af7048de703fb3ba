"""Pictures as files: how large, and never half-written."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

from viewer.app.whole_file import write_whole
from viewer.commands import CommandError, SavePicture

__all__ = ["checked_order", "picture_size", "save_png"]

LEAST_SIDE = 64
LARGEST_SIDE = 8192
"""Of a picture file [pixels]."""


def checked_order(order: SavePicture) -> SavePicture:
    """Return the order.

    Raises:
        CommandError: a side is not a whole number of pixels, too small or too large.
    """
    for name, side in (("width", order.width), ("height", order.height)):
        if side is not None and not (LEAST_SIDE <= side <= LARGEST_SIDE and side == int(side)):
            raise CommandError(
                f"SavePicture.{name} = {side:g} is not allowed; it must be a whole number"
                f" from {LEAST_SIDE} to {LARGEST_SIDE} pixels"
            )
    return order


def picture_size(order: SavePicture, shown: tuple[int, int]) -> tuple[int, int]:
    """Width and height of the file [pixels].

    Args:
        order: what was asked for; one side alone keeps the shape of the picture shown.
        shown: width and height of the picture shown [pixels].
    """
    width, height = order.width, order.height
    if width is None and height is None:
        return shown
    if width is None and height is not None:
        width = min(LARGEST_SIDE, max(LEAST_SIDE, round(height * shown[0] / shown[1])))
    elif height is None and width is not None:
        height = min(LARGEST_SIDE, max(LEAST_SIDE, round(width * shown[1] / shown[0])))
    assert width is not None
    assert height is not None
    return int(width), int(height)


def save_png(path: Path, pixels: npt.NDArray[np.uint8]) -> None:
    """Write an RGB picture, rows from the top, as PNG; a half-written file never bears the name.

    Raises:
        OSError: it cannot be written.
    """
    packed = io.BytesIO()
    Image.fromarray(pixels).save(packed, format="PNG")
    write_whole(path, packed.getvalue())
