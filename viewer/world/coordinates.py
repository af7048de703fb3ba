"""The world frame in which cameras and pictures live.

World axes: x = east, y = up, z = -north, in metres; the origin lies at the centre of the grid and at the
elevation datum of the case. Heights may be exaggerated about a reference elevation:

    x_world = x - x_centre
    y_world = z_ref + exaggeration (z - z_ref)
    z_world = -(y - y_centre)
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from protocol import GridGeometry

__all__ = ["Point", "WorldFrame"]

Point = tuple[float, float, float]


@dataclass(frozen=True)
class WorldFrame:
    """The map between grid coordinates and the world.

    Grid coordinates are x and y of the CRS [m] and the elevation z relative to the case datum [m].
    """

    x_centre: float
    """Easting of the grid's centre [m]."""
    y_centre: float
    """Northing of the grid's centre [m]."""
    z_ref: float = 0.0
    """Elevation that stays where it is under exaggeration [m, datum-relative]."""
    exaggeration: float = 1.0
    """Vertical exaggeration, > 0."""

    @classmethod
    def of_grid(cls, grid: GridGeometry, z_ref: float = 0.0) -> WorldFrame:
        """The frame centred on a grid."""
        xmin, ymin, xmax, ymax = grid.extent
        return cls(0.5 * (xmin + xmax), 0.5 * (ymin + ymax), z_ref)

    def exaggerated(self, exaggeration: float) -> WorldFrame:
        """The same frame with another vertical exaggeration."""
        return replace(self, exaggeration=float(exaggeration))

    def height(self, z: Any) -> Any:
        """World y [m] of an elevation (scalar or array)."""
        return self.z_ref + self.exaggeration * (z - self.z_ref)

    def elevation(self, y: Any) -> Any:
        """Elevation [m, datum-relative] of a world y (scalar or array)."""
        return self.z_ref + (y - self.z_ref) / self.exaggeration

    def to_world(self, x: float, y: float, z: float) -> Point:
        """World point of a place given in grid coordinates."""
        return (float(x - self.x_centre), float(self.height(z)), float(self.y_centre - y))

    def from_world(self, point: Point) -> Point:
        """Grid coordinates (x, y, elevation) of a world point."""
        return (
            float(point[0] + self.x_centre),
            float(self.y_centre - point[2]),
            float(self.elevation(point[1])),
        )

    def to_world_array(self, xyz: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """World points, shape [n, 3], of places in grid coordinates, shape [n, 3]."""
        places = np.asarray(xyz, dtype=np.float64)
        return np.stack(
            [places[..., 0] - self.x_centre, self.height(places[..., 2]), self.y_centre - places[..., 1]],
            axis=-1,
        )
