"""The terrains, floods and cameras of `bench viewer_tables`.

Three terrains of the sizes in the paper's Table 5.1: a crop of Malpasset with the flood that the solver
computes on it, a crop of an SRTM tile with a lake, and one of a coast with the sea. As many blocks hold water
there as in the paper's Table 5.2: its shares are those of all blocks that are not dry, for with them its
triangles add up (Sardis: 11.72 % of the water and all of the ground with LOD are 500 000 of 524 557). Nothing
is made finer than the data. `FEV_DATA_HOME` names the folder of the data.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.ndimage import label

from protocol import GridGeometry
from solver_service.numerics import ShallowWaterSolver
from solver_service.scenario import load_case
from solver_service.terrain import read_dem
from viewer.lod import BlockTiling, classify_blocks
from viewer.world import Camera, Heightfield, overview

Raster = npt.NDArray[np.float32]

SIZE = (1280, 720)
DRY, WET = 0, 2
FLIGHT_DISTANCE, FLIGHT_PITCH_DEG = 0.12, 35.0

PAPER_SHARES = {"Malpasset": (0.0305, 0.3012), "Sardis": (0.0586, 0.1172), "RossBarnett": (0.1667, 0.3708)}
"""Least and most of the blocks with water, the paper's Table 5.2."""

MALPASSET_ROWS, MALPASSET_COLS = slice(60, 500), slice(20, 1120)
MALPASSET_TIMES = tuple(500.0 * k for k in range(9))


@dataclass(frozen=True)
class Scene:
    """A terrain with the waters of a test."""

    name: str
    paper_name: str
    """The paper's data set of the same size."""
    field: Heightfield
    waters: tuple[Raster, ...]
    """Depths [m] at the output times, or at rising levels."""
    origin: str
    """Where terrain and water come from."""

    def wet_share(self, h: Raster) -> float:
        """Share of the blocks of 33 x 33 vertices that are fully wet."""
        return float((_states(h) == WET).mean())

    def water_share(self, h: Raster) -> float:
        """Share of the blocks with water in any vertex."""
        return float((_states(h) != DRY).mean())

    @property
    def least(self) -> Raster:
        """The water that reaches the fewest blocks."""
        return min(self.waters, key=self.water_share)

    @property
    def most(self) -> Raster:
        """The water that reaches the most blocks."""
        return max(self.waters, key=self.water_share)

    def camera(self) -> Camera:
        """The whole map from the south at 38 degrees, filling the picture."""
        grid = self.field.grid
        middle = 0.5 * (self.field.z_min + self.field.z_max)
        return overview(grid.ncols * grid.dx, grid.nrows * grid.dx, middle, aspect=SIZE[0] / SIZE[1])

    def flight(self, poses: int = 24) -> list[Camera]:
        """A round flight over the map as an operator looks a flood over.

        Along an ellipse half as large as the map, looking ahead at the ground of the way, 35 degrees down,
        from 0.12 of the longer side away.
        """
        grid = self.field.grid
        width, height = grid.ncols * grid.dx, grid.nrows * grid.dx
        distance = FLIGHT_DISTANCE * max(width, height)
        cameras = []
        for turn in np.arange(poses) * (2.0 * math.pi / poses):
            x, y = 0.25 * width * math.cos(turn), 0.25 * height * math.sin(turn)
            east, north = -width * math.sin(turn), height * math.cos(turn)
            ground = float(self.field.world_height(x, -y))
            azimuth = math.atan2(east, north)
            cameras.append(Camera((x, ground, -y), distance, azimuth, math.radians(FLIGHT_PITCH_DEG)))
        return cameras


def scenes(smoke: bool) -> list[Scene]:
    """The scenes there is data for; a small one of the embedded case for smoke."""
    if smoke:
        return [_embedded()]
    home = Path(os.environ.get("FEV_DATA_HOME", ""))
    found = [_malpasset()] if (home / "malpasset").is_dir() else []
    srtm = home / "terrain" / "srtm"
    if srtm.is_dir():
        found += [_square(srtm), _large(srtm)]
    return found or [_embedded()]


def wall_of_water(field: Heightfield, share: float) -> Raster:
    """Water 10 m deep over the western `share` of the map, as in the paper's section 5.2."""
    h = np.zeros_like(field.z_b)
    h[:, : round(share * field.grid.ncols)] = 10.0
    return h


def _malpasset() -> Scene:
    case = load_case("malpasset")
    solver = ShallowWaterSolver(case.model, case.params)
    solver.set_water(case.initial_h)
    waters = []
    for time in MALPASSET_TIMES:
        solver.advance_to(time)
        waters.append(np.ascontiguousarray(solver.depth()[MALPASSET_ROWS, MALPASSET_COLS]))
    bed = case.z_b[MALPASSET_ROWS, MALPASSET_COLS]
    blocked = case.model.blocked
    outside = None if blocked is None else np.ascontiguousarray(blocked[MALPASSET_ROWS, MALPASSET_COLS])
    times = ", ".join(f"{time:g}" for time in MALPASSET_TIMES)
    origin = f"15 m raster of Malpasset, flood computed by the solver, t = {times} s"
    return Scene("malpasset", "Malpasset", _field(bed, 15.0, outside), tuple(waters), origin)


def _square(folder: Path) -> Scene:
    """1026 x 1026 of the tile of the upper Palatinate, its cells taken as squares."""
    z = _tile(folder / "N49E011.hgt.zip")[80 : 80 + 1026, 100 : 100 + 1026]
    shares = PAPER_SHARES["Sardis"]
    return _filled("srtm_1026", "Sardis", z, 75.0, shares, "SRTM tile N49E011, 3 arc seconds")


def _large(folder: Path) -> Scene:
    """1949 x 2113 of the coast of Washington with the sea; void rows mirror the ground before them."""
    z = _tile(folder / "N48W125.hgt.zip")
    valid = z[:1800]
    z = np.concatenate([valid, valid[: -(1949 - 1800) - 1 : -1]])[:, 1116 : 1116 + 2113]
    sea = np.where(z <= 0.0, np.float32(0.5) - z, np.float32(0.0)).astype(np.float32)
    origin = (
        "SRTM tile N48W125, 1 arc second; the void rows in the north mirror the ground before them; the sea"
        " 0.5 m high, as far as a front that comes in from the west has got"
    )
    waters = tuple(_front(sea, share) for share in PAPER_SHARES["RossBarnett"])
    return Scene("srtm_2113", "RossBarnett", _field(z, 25.0), waters, origin)


def _embedded() -> Scene:
    case = load_case("jacksboro")
    bed = case.z_b[100:360, 300:560]
    return _filled("jacksboro", "none", bed, case.grid.dx, (0.1, 0.3), "embedded case, lower 260 x 260 cells")


def _filled(
    name: str, paper_name: str, z: Raster, dx: float, shares: tuple[float, float], origin: str
) -> Scene:
    field = _field(z, dx)
    waters = tuple(_lake(field.z_b, share) for share in shares)
    return Scene(name, paper_name, field, waters, f"{origin}; a lake filled up to a level")


def _front(h: Raster, share: float) -> Raster:
    """As much of a water, from the west, as reaches at most `share` of the blocks."""
    reached = np.cumsum((_states(h) != DRY).sum(axis=0)) / _states(h).size
    # The last column of blocks holds a single vertex of the front.
    cols = 32 * (int(np.searchsorted(reached, share, side="right")) - 1) + 1
    part = np.zeros_like(h)
    part[:, :cols] = h[:, :cols]
    return part


def _states(h: Raster) -> npt.NDArray[np.uint8]:
    return classify_blocks(h, BlockTiling(h.shape[0], h.shape[1]))


def _lake(z_b: Raster, share: float) -> Raster:
    """The largest lake of level water that reaches at most `share` of the blocks."""
    low, high = float(z_b.min()), float(z_b.max())
    for _ in range(16):
        level = 0.5 * (low + high)
        reached = float((_states(_lake_at(z_b, level)) != DRY).mean())
        low, high = (level, high) if reached <= share else (low, level)
    return _lake_at(z_b, low)


def _lake_at(z_b: Raster, level: float) -> Raster:
    ponds, count = label(z_b < level)
    h = np.zeros_like(z_b)
    if count:
        largest = ponds == 1 + int(np.argmax(np.bincount(ponds.ravel())[1:]))
        h[largest] = np.float32(level) - z_b[largest]
    return h


def _tile(path: Path) -> Raster:
    raster = read_dem(path)
    z: Raster = np.array(raster.values, np.float32)
    void = ~np.isfinite(z)
    if void.any() and not void.all():
        valid_rows = ~void.all(axis=1)
        z[valid_rows] = np.where(void[valid_rows], np.nanmin(z), z[valid_rows])
    return np.ascontiguousarray(z)


def _field(z: Raster, dx: float, outside: npt.NDArray[np.bool_] | None = None) -> Heightfield:
    z = np.ascontiguousarray(z - z.min(), np.float32)
    return Heightfield(GridGeometry(z.shape[0], z.shape[1], dx, 0.0, 0.0), z, outside)
