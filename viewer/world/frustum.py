"""The view frustum: six planes and a test of many boxes at once."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

__all__ = ["Frustum"]


class Frustum:
    """Six planes (a, b, c, d) with a x + b y + c z + d >= 0 inside, taken from a view-projection matrix."""

    def __init__(self, view_projection: npt.NDArray[np.float64]) -> None:
        """Take the planes out of a matrix that acts on column vectors (Gribb and Hartmann 2001)."""
        rows = np.asarray(view_projection, dtype=np.float64)
        planes = np.array(
            [
                rows[3] + rows[0],
                rows[3] - rows[0],
                rows[3] + rows[1],
                rows[3] - rows[1],
                rows[3] + rows[2],
                rows[3] - rows[2],
            ]
        )
        self.planes = planes / np.linalg.norm(planes[:, :3], axis=1, keepdims=True)

    def intersects_boxes(
        self, centre: npt.NDArray[np.floating], half: npt.NDArray[np.floating]
    ) -> npt.NDArray[np.bool_]:
        """Which boxes may be seen; never False for a box of which a point lies inside.

        Args:
            centre: centres of the boxes [m], shape [3, n].
            half: half sizes of the boxes [m], shape [3, n].

        Returns:
            bool array, shape [n].
        """
        visible = np.ones(centre.shape[1], dtype=np.bool_)
        for a, b, c, d in self.planes.tolist():
            # The box corner farthest along the plane's normal decides.
            reach = a * centre[0] + b * centre[1] + c * centre[2]
            reach += abs(a) * half[0] + abs(b) * half[1] + abs(c) * half[2]
            visible &= reach >= -d
        return visible
