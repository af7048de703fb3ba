r"""From world error to screen error: at which distance a block may use a level.

A vertical error e at distance d covers at most e k g / d pixels, where

    k = H / (2 tan(fov / 2))      pixels a unit of slope at the centre of a picture of H pixels
    g = g(pitch)                  what the direction of view makes of a vertical displacement

so level l of a block with error e_l may be used from the switch distance D_l = e_l k g / tau on.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

__all__ = ["SwitchTable", "pixels_per_slope", "screen_error_factor"]

Array = npt.NDArray[np.float32]


def pixels_per_slope(height_px: int, fov_y: float) -> float:
    """Pixels that one unit of slope covers at the centre of the picture.

    Args:
        height_px: height of the picture [pixels].
        fov_y: vertical angle of view [rad].
    """
    return height_px / (2.0 * math.tan(0.5 * fov_y))


def screen_error_factor(pitch: float, fov_y: float, aspect: float) -> float:
    """Upper bound of the screen length of a vertical unit, relative to one seen square-on.

    In eye space a vertical displacement is (0, cos p, sin p). It moves a projected point at depth z by at
    most sqrt((cos p + tan_y sin p)^2 + (tan_x sin p)^2) / z, with tan_x and tan_y those of the picture's
    corner, and z is at least the distance times the cosine of the corner's angle off axis.

    Args:
        pitch: angle of the view direction below the horizon [rad].
        fov_y: vertical angle of view [rad].
        aspect: width over height of the picture.
    """
    tan_y = math.tan(0.5 * fov_y)
    tan_x = tan_y * aspect
    s, c = abs(math.sin(pitch)), math.cos(pitch)
    return math.hypot(c + tan_y * s, tan_x * s) * math.sqrt(1.0 + tan_x * tan_x + tan_y * tan_y)


class SwitchTable:
    """Switch distances of all blocks and levels, for any threshold and picture.

    Only the product of error and pixel scale matters, so the table keeps errors, made monotone over the
    levels, and scales the distance instead: a new threshold costs nothing.
    """

    def __init__(self, errors: Array, charges: Array | None = None) -> None:
        """Take the errors.

        Args:
            errors: error of each level [m], shape [level_count, block_rows, block_cols].
            charges: error that each level causes in the blocks beside it (`edge_errors`); None for none.
        """
        self._level_count = errors.shape[0]
        self._shape = errors.shape[1:]
        self._monotone = np.zeros((self._level_count, int(np.prod(self._shape))), dtype=np.float32)
        self._charges = np.zeros_like(self._monotone)
        self.update(errors, charges, (0, 0, *self._shape))

    @property
    def level_count(self) -> int:
        """Levels of detail."""
        return int(self._level_count)

    def update(self, errors: Array, charges: Array | None, blocks: tuple[int, int, int, int]) -> None:
        """Refresh a rectangle of blocks.

        Args:
            errors: their errors [m], shape [level_count, rows, cols].
            charges: their charges [m], of the same shape; None for none.
            blocks: first block row, first block column, end block row, end block column.
        """
        window = (slice(None), slice(blocks[0], blocks[2]), slice(blocks[1], blocks[3]))
        shape = (self._level_count, *self._shape)
        # A finer level must never be refused where a coarser one is allowed.
        self._monotone.reshape(shape)[window] = np.maximum.accumulate(errors, axis=0)
        if charges is not None:
            self._charges.reshape(shape)[window] = np.maximum.accumulate(charges, axis=0)

    def distances(self, pixel_scale: float, tau_px: float) -> Array:
        """The switch distances D_l [m], shape [level_count, block_count].

        Args:
            pixel_scale: `pixels_per_slope` times `screen_error_factor` (times the vertical exaggeration).
            tau_px: screen error allowed [pixels], > 0.
        """
        return self._monotone * np.float32(pixel_scale / tau_px)

    def levels(
        self,
        distance: Array,
        pixel_scale: float,
        tau_px: float,
        distance_beside: Array | None = None,
        at: slice | npt.NDArray[np.int64] = slice(None),
    ) -> npt.NDArray[np.uint8]:
        """The coarsest level that each block may use.

        Args:
            distance: from the eye to the nearest point of each block's box [m], shape [n].
            pixel_scale: as in `distances`.
            tau_px: as in `distances`.
            distance_beside: the least distance of the block and those beside it [m]; None takes `distance`.
            at: the blocks asked for, all or n of them.
        """
        per_metre = np.float32(tau_px / pixel_scale)
        allowed = distance * per_metre
        beside = allowed if distance_beside is None else distance_beside * per_metre
        level = np.zeros(distance.shape, dtype=np.uint8)
        for errors, charges in zip(self._monotone[1:], self._charges[1:], strict=True):
            level += (errors[at] <= allowed) & (charges[at] <= beside)
        return level
