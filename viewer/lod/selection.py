"""Choosing, for one picture, which blocks are drawn and at which level.

Flat and vectorised over all blocks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from viewer.lod.block_errors import BlockBounds
from viewer.lod.block_tiling import BlockTiling
from viewer.lod.switch_table import SwitchTable, pixels_per_slope, screen_error_factor
from viewer.world.camera import Camera
from viewer.world.coordinates import WorldFrame
from viewer.world.frustum import Frustum

__all__ = ["INSTANCE_DTYPE", "BlockSelector", "LodStats", "Selection"]

DRY, PARTIAL, WET = 0, 1, 2

INSTANCE_DTYPE = np.dtype(
    [("col", "<u2"), ("row", "<u2"), ("w", "u1"), ("e", "u1"), ("s", "u1"), ("n", "u1")]
)
"""One drawn block: its place among the blocks, and the level to which each edge is fitted."""


@dataclass(frozen=True)
class LodStats:
    """What a selection draws."""

    terrain_triangles: int
    """Triangles with an area, edges fitted to coarser neighbours counted as they are drawn."""
    water_triangles: int
    terrain_blocks: int
    water_blocks: int
    culled_blocks: int
    """Blocks outside of the view."""
    covered_blocks: int
    """Blocks in view whose terrain is not drawn because water covers all of it."""


@dataclass(frozen=True)
class Selection:
    """The blocks of one picture."""

    level: npt.NDArray[np.uint8]
    """Level of every block, drawn or not, shape [block_count]."""
    visible: npt.NDArray[np.bool_]
    """Whether a block may be in view, shape [block_count]."""
    terrain: tuple[npt.NDArray[np.void], ...]
    """Instances of terrain blocks by level, each of `INSTANCE_DTYPE`."""
    water: tuple[npt.NDArray[np.void], ...]
    """Instances of water blocks by level."""
    distance_min: float
    """From the eye to the nearest box in view [m]; infinite if none is."""
    distance_max: float
    """From the eye to the farthest point of a box in view [m]; 0 if none is."""
    stats: LodStats


class BlockSelector:
    """Selects blocks of one terrain for any camera."""

    def __init__(self, tiling: BlockTiling, dx: float, table: SwitchTable, bounds: BlockBounds) -> None:
        """Take what is known ahead of time.

        Args:
            tiling: the blocks.
            dx: cell size [m].
            table: switch distances.
            bounds: lowest and highest ground of each block [m, datum-relative]; read anew at each selection.
        """
        self._tiling = tiling
        self._dx = dx
        self._table = table
        self._bounds = bounds
        x_of_col = (np.arange(tiling.ncols) - 0.5 * (tiling.ncols - 1)) * dx
        y_of_row = (np.arange(tiling.nrows) - 0.5 * (tiling.nrows - 1)) * dx
        west, east = x_of_col[tiling.col_start], x_of_col[tiling.col_end]
        south, north = y_of_row[tiling.row_start], y_of_row[tiling.row_end]
        rows, cols = np.divmod(np.arange(tiling.block_count), tiling.block_cols)
        self._centre = np.zeros((3, tiling.block_count), dtype=np.float32)
        self._half = np.zeros((3, tiling.block_count), dtype=np.float32)
        self._centre[0], self._half[0] = (0.5 * (west + east))[cols], (0.5 * (east - west))[cols]
        self._centre[2], self._half[2] = (-0.5 * (south + north))[rows], (0.5 * (north - south))[rows]
        self._instances = np.zeros(tiling.block_count, dtype=INSTANCE_DTYPE)
        self._instances["col"], self._instances["row"] = cols, rows
        # A rim of level 0 around the blocks: the border of the map has no coarser neighbour.
        self._padded = np.zeros((tiling.block_rows + 2, tiling.block_cols + 2), dtype=np.uint8)

    def select(
        self,
        camera: Camera,
        frame: WorldFrame,
        size: tuple[int, int],
        tau_px: float,
        *,
        states: npt.NDArray[np.uint8] | None = None,
        depth_max: float = 0.0,
        pinned: npt.NDArray[np.bool_] | None = None,
        water_spacing_px: float = 0.0,
        partial_spacing_px: float = 0.0,
        cull: bool = True,
        cull_covered_terrain: bool = True,
        classify_water: bool = True,
        full_mesh: bool = False,
    ) -> Selection:
        """Choose the blocks of one picture.

        Args:
            camera: the view.
            frame: world frame with the vertical exaggeration drawn.
            size: width and height of the picture [pixels].
            tau_px: screen error allowed [pixels].
            states: water state of each block (0 dry, 1 partial, 2 wet), shape [block_count]; None for no
                water.
            depth_max: deepest water anywhere [m]; boxes of blocks with water reach that much higher.
            pinned: blocks held at full resolution (edited, errors not refreshed yet), shape [block_count].
            water_spacing_px: spacing of vertices allowed in fully wet blocks [pixels]; 0 draws all vertices.
            partial_spacing_px: the same for partial blocks.
            cull: whether to leave out blocks outside of the view.
            cull_covered_terrain: whether to leave out terrain under fully wet blocks.
            classify_water: whether to go by the water states; without, every block in view draws all vertices
                of the water, and the terrain knows of none.
            full_mesh: draw all vertices of all blocks.
        """
        width, height = size
        aspect = width / height
        self._set_heights(frame, states, depth_max)
        offset = np.abs(self._centre - camera.eye.astype(np.float32)[:, None])
        nearest = np.maximum(offset - self._half, 0.0)
        distance = np.sqrt((nearest * nearest).sum(axis=0))

        slope_px = pixels_per_slope(height, camera.fov_y)
        if full_mesh:
            level = np.zeros(self._tiling.block_count, dtype=np.uint8)
        else:
            scale = (
                slope_px * frame.exaggeration * screen_error_factor(camera.elevation, camera.fov_y, aspect)
            )
            level = self._table.levels(distance, scale, tau_px, self._least_beside(distance))
            if states is not None and classify_water:
                level[states == PARTIAL] = self._spacing_levels(
                    distance[states == PARTIAL], slope_px, partial_spacing_px
                )
                level[states == WET] = self._spacing_levels(
                    distance[states == WET], slope_px, water_spacing_px
                )
            if pinned is not None:
                level[pinned] = 0

        visible = np.ones(self._tiling.block_count, dtype=np.bool_)
        if cull:
            frustum = Frustum(camera.projection(aspect, 1e-2, 1e7) @ camera.view_matrix())
            visible = frustum.intersects_boxes(self._centre, self._half)
        selection = self._collect(
            level, visible, states if classify_water else None, cull_covered_terrain, distance, offset
        )
        return selection if states is None or classify_water else self._with_all_water(selection)

    def _with_all_water(self, selection: Selection) -> Selection:
        """The same selection with every block in view as water at full resolution."""
        visible = selection.visible
        instances = self._instances[visible]
        for edge in "wesn":
            instances[edge] = 0
        water = (instances, *(instances[:0] for _ in range(1, self._tiling.level_count)))
        stats = replace(
            selection.stats,
            water_triangles=int(self._tiling.triangle_counts[0][visible].sum()),
            water_blocks=int(visible.sum()),
        )
        return replace(selection, water=water, stats=stats)

    def _set_heights(self, frame: WorldFrame, states: npt.NDArray[np.uint8] | None, depth_max: float) -> None:
        low = frame.height(self._bounds.z_min.ravel())
        high = frame.height(self._bounds.z_max.ravel())
        if states is not None and depth_max > 0.0:
            high = high + (states != DRY) * np.float32(depth_max * frame.exaggeration)
        self._centre[1] = 0.5 * (low + high)
        self._half[1] = 0.5 * (high - low)

    def _least_beside(self, distance: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """The least distance of each block and the four beside it."""
        padded = np.full((self._tiling.block_rows + 2, self._tiling.block_cols + 2), np.inf, dtype=np.float32)
        padded[1:-1, 1:-1] = distance.reshape(self._tiling.block_rows, self._tiling.block_cols)
        least = np.minimum(padded[1:-1, 1:-1], padded[1:-1, :-2])
        for beside in (padded[1:-1, 2:], padded[:-2, 1:-1], padded[2:, 1:-1]):
            np.minimum(least, beside, out=least)
        return least.ravel()

    def _spacing_levels(
        self, distance: npt.NDArray[np.float32], slope_px: float, spacing_px: float
    ) -> npt.NDArray[np.uint8]:
        """The coarsest level whose vertices lie no more than so many pixels apart."""
        if spacing_px <= 0.0:
            return np.zeros(distance.shape, dtype=np.uint8)
        cells = np.maximum(distance * np.float32(spacing_px / (slope_px * self._dx)), 1.0)
        coarsest = self._tiling.level_count - 1
        return np.asarray(np.minimum(np.log2(cells), coarsest), dtype=np.uint8)

    def _collect(
        self,
        level: npt.NDArray[np.uint8],
        visible: npt.NDArray[np.bool_],
        states: npt.NDArray[np.uint8] | None,
        cull_covered_terrain: bool,
        distance: npt.NDArray[np.float32],
        offset: npt.NDArray[np.float32],
    ) -> Selection:
        tiling = self._tiling
        grid = level.reshape(tiling.block_rows, tiling.block_cols)
        padded, instances = self._padded, self._instances
        padded[1:-1, 1:-1] = grid
        instances["w"] = np.maximum(grid, padded[1:-1, :-2]).ravel()
        instances["e"] = np.maximum(grid, padded[1:-1, 2:]).ravel()
        instances["s"] = np.maximum(grid, padded[:-2, 1:-1]).ravel()
        instances["n"] = np.maximum(grid, padded[2:, 1:-1]).ravel()

        has_water = np.zeros_like(visible) if states is None else visible & (states != DRY)
        covered = np.zeros_like(visible)
        if states is not None and cull_covered_terrain:
            covered = visible & (states == WET)
        drawn = visible & ~covered
        terrain, water = [], []
        for number in range(tiling.level_count):
            at_level = level == number
            terrain.append(instances[drawn & at_level])
            water.append(instances[has_water & at_level])
        far_corner = (offset + self._half)[:, visible]
        stats = LodStats(
            terrain_triangles=self._triangles(terrain, drawn, level),
            water_triangles=self._triangles(water, has_water, level),
            terrain_blocks=int(drawn.sum()),
            water_blocks=int(has_water.sum()),
            culled_blocks=int(visible.size - visible.sum()),
            covered_blocks=int(covered.sum()),
        )
        return Selection(
            level=level,
            visible=visible,
            terrain=tuple(terrain),
            water=tuple(water),
            distance_min=float(distance[visible].min()) if far_corner.size else float("inf"),
            distance_max=float(np.sqrt((far_corner * far_corner).sum(axis=0).max()))
            if far_corner.size
            else 0.0,
            stats=stats,
        )

    def _triangles(
        self, by_level: list[npt.NDArray[np.void]], drawn: npt.NDArray[np.bool_], level: npt.NDArray[np.uint8]
    ) -> int:
        """Triangles with an area: each vertex that an edge gives up leaves one triangle without."""
        blocks = np.flatnonzero(drawn)
        count = int(self._tiling.triangle_counts[level[blocks], blocks].sum())
        rows = self._tiling.row_end - self._tiling.row_start
        cols = self._tiling.col_end - self._tiling.col_start
        for number, instances in enumerate(by_level):
            for edge in "wesn":
                fitted = instances[instances[edge] > number]
                if fitted.size:
                    length = rows[fitted["row"]] if edge in "we" else cols[fitted["col"]]
                    coarse = fitted[edge].astype(np.int64)
                    count -= int((-(-length // (1 << number)) - -(-length // (1 << coarse))).sum())
        return count
