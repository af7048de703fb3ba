"""Choosing, for one picture, which blocks are drawn and at which level.

Vectorised over the blocks in question: all of them, or those that a quadtree finds. Both give equal results.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from viewer.lod.block_errors import BlockBounds
from viewer.lod.block_tiling import BlockTiling
from viewer.lod.quadtree import BlockQuadtree
from viewer.lod.selection import INSTANCE_DTYPE, LodStats, Selection, count_triangles
from viewer.lod.switch_table import SwitchTable, pixels_per_slope, screen_error_factor
from viewer.world.camera import Camera
from viewer.world.coordinates import WorldFrame
from viewer.world.frustum import Frustum

__all__ = ["FLAT_BLOCKS", "BlockSelector"]

DRY, PARTIAL, WET = 0, 1, 2

FLAT_BLOCKS = 4096
"""Up to so many blocks looking at all of them costs no more than going down a tree."""

Blocks = slice | npt.NDArray[np.int64]
"""Which blocks are looked at: all of them, or their numbers in rising order."""


class BlockSelector:
    """Selects blocks of one terrain for any camera."""

    def __init__(self, tiling: BlockTiling, dx: float, table: SwitchTable, bounds: BlockBounds) -> None:
        """Take what is known ahead of time.

        Args:
            tiling: the blocks.
            dx: cell size [m].
            table: switch distances.
            bounds: lowest and highest ground of each block [m, datum-relative]; `refresh` tells of changes.
        """
        self._tiling = tiling
        self._dx = dx
        self._table = table
        self._bounds = bounds
        self._tree: BlockQuadtree | None = None
        west, east = ((at - 0.5 * (tiling.ncols - 1)) * dx for at in (tiling.col_start, tiling.col_end))
        south, north = ((at - 0.5 * (tiling.nrows - 1)) * dx for at in (tiling.row_start, tiling.row_end))
        rows, cols = np.divmod(np.arange(tiling.block_count), tiling.block_cols)
        self._centre = np.zeros((3, tiling.block_count), dtype=np.float32)
        self._half = np.zeros((3, tiling.block_count), dtype=np.float32)
        self._centre[0], self._half[0] = (0.5 * (west + east))[cols], (0.5 * (east - west))[cols]
        self._centre[2], self._half[2] = (-0.5 * (south + north))[rows], (0.5 * (north - south))[rows]
        self._instances = np.zeros(tiling.block_count, dtype=INSTANCE_DTYPE)
        self._instances["col"], self._instances["row"] = cols, rows
        # Blocks have a rim around them here, so that every one has four neighbours.
        self._pitch = tiling.block_cols + 2
        self._rim_size = (tiling.block_rows + 2) * self._pitch
        self._place = (rows + 1) * self._pitch + cols + 1
        self._beside = {"w": -1, "e": 1, "s": -self._pitch, "n": self._pitch}

    def refresh(self) -> None:
        """Take over bounds that have changed."""
        if self._tree is not None:
            self._tree.refresh()

    def select(
        self,
        camera: Camera,
        frame: WorldFrame,
        size: tuple[int, int],
        tau_px: float,
        *,
        states: npt.NDArray[np.uint8] | None = None,
        depth_max: float = 0.0,
        water_spacing_px: float = 0.0,
        partial_spacing_px: float = 0.0,
        cull: bool = True,
        cull_covered_terrain: bool = True,
        classify_water: bool = True,
        full_mesh: bool = False,
        quadtree: bool | None = None,
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
            water_spacing_px: spacing of vertices allowed in fully wet blocks [pixels]; 0 draws all vertices.
            partial_spacing_px: the same for partial blocks.
            cull: whether to leave out blocks outside of the view.
            cull_covered_terrain: whether to leave out terrain under fully wet blocks.
            classify_water: whether to go by the water states; without, every block in view draws all vertices
                of the water, and the terrain knows of none.
            full_mesh: draw all vertices of all blocks.
            quadtree: whether blocks in view are found by the quadtree; None does so above `FLAT_BLOCKS`.
        """
        width, height = size
        aspect = width / height
        frustum = Frustum(camera.projection(aspect, 1e-2, 1e7) @ camera.view_matrix()) if cull else None
        water_height = depth_max * frame.exaggeration if states is not None else 0.0
        use_tree = self._tiling.block_count > FLAT_BLOCKS if quadtree is None else quadtree
        at: Blocks = slice(None)
        if frustum is not None and use_tree:
            at = self._around_view(frustum, frame, water_height)
        centre, half = self._boxes(at, frame, states, water_height)
        offset = np.abs(centre - camera.eye.astype(np.float32)[:, None])
        nearest = np.maximum(offset - half, 0.0)
        distance = np.sqrt((nearest * nearest).sum(axis=0))

        slope_px = pixels_per_slope(height, camera.fov_y)
        if full_mesh:
            level = np.zeros(distance.shape, dtype=np.uint8)
        else:
            scale = (
                slope_px * frame.exaggeration * screen_error_factor(camera.elevation, camera.fov_y, aspect)
            )
            level = self._table.levels(distance, scale, tau_px, self._least_beside(at, distance), at)
            if states is not None and classify_water:
                for state, spacing in ((PARTIAL, partial_spacing_px), (WET, water_spacing_px)):
                    of_state = states[at] == state
                    level[of_state] = self._spacing_levels(distance[of_state], slope_px, spacing)

        visible = np.ones(distance.shape, dtype=np.bool_)
        if frustum is not None:
            visible = frustum.intersects_boxes(centre, half)
        far_corner = (offset + half)[:, visible]
        farthest = float(np.sqrt((far_corner * far_corner).sum(axis=0).max())) if far_corner.size else 0.0
        reach = (float(distance[visible].min()) if far_corner.size else float("inf"), farthest)
        selection = self._collect(
            at, level, visible, states if classify_water else None, cull_covered_terrain, reach
        )
        return selection if states is None or classify_water else self._with_all_water(selection)

    def _around_view(self, frustum: Frustum, frame: WorldFrame, water_height: float) -> Blocks:
        """Blocks that may be in view, and two rings of others: edges go by neighbours, and they by theirs."""
        if self._tree is None:
            self._tree = BlockQuadtree(self._tiling, self._dx, self._bounds)
        candidates = self._tree.candidates(frustum, frame, water_height)
        if 2 * candidates.size > self._tiling.block_count:
            return slice(None)
        asked = np.zeros(self._rim_size, dtype=np.bool_)
        asked[self._place[candidates]] = True
        grid = asked.reshape(-1, self._pitch)
        for _ in range(2):
            inner = grid[1:-1, 1:-1] | grid[1:-1, :-2] | grid[1:-1, 2:] | grid[:-2, 1:-1] | grid[2:, 1:-1]
            grid[1:-1, 1:-1] = inner
        return np.flatnonzero(grid[1:-1, 1:-1])

    def _with_all_water(self, selection: Selection) -> Selection:
        """The same selection with every block in view as water at full resolution."""
        visible = selection.visible
        instances = self._instances[visible]
        for edge in self._beside:
            instances[edge] = 0
        water = (instances, *(instances[:0] for _ in range(1, self._tiling.level_count)))
        stats = replace(
            selection.stats,
            water_triangles=int(self._tiling.triangle_counts[0][visible].sum()),
            water_blocks=int(visible.sum()),
        )
        return replace(selection, water=water, stats=stats)

    def _boxes(
        self, at: Blocks, frame: WorldFrame, states: npt.NDArray[np.uint8] | None, water_height: float
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Centres and half sizes of the boxes of some blocks, each of shape [3, n]."""
        low = frame.height(self._bounds.z_min.ravel()[at])
        high = frame.height(self._bounds.z_max.ravel()[at])
        if states is not None and water_height > 0.0:
            high = high + (states[at] != DRY) * np.float32(water_height)
        centre, half = self._centre[:, at], self._half[:, at]
        centre[1], half[1] = 0.5 * (low + high), 0.5 * (high - low)
        return centre, half

    def _least_beside(self, at: Blocks, distance: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        """The least distance of each block and the four beside it."""
        place = self._place[at]
        padded = np.full(self._rim_size, np.inf, dtype=np.float32)
        padded[place] = distance
        least = distance.copy()
        for step in self._beside.values():
            np.minimum(least, padded[place + step], out=least)
        return least

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
        at: Blocks,
        level: npt.NDArray[np.uint8],
        visible: npt.NDArray[np.bool_],
        states: npt.NDArray[np.uint8] | None,
        cull_covered_terrain: bool,
        reach: tuple[float, float],
    ) -> Selection:
        tiling = self._tiling
        blocks = np.arange(tiling.block_count)[at]
        place = self._place[at]
        # The rim has level 0: the border of the map has no coarser neighbour.
        padded = np.zeros(self._rim_size, dtype=np.uint8)
        padded[place] = level
        seen, place, seen_level = blocks[visible], place[visible], level[visible]
        instances = self._instances[seen]
        for edge, step in self._beside.items():
            instances[edge] = np.maximum(seen_level, padded[place + step])

        has_water = np.zeros(seen.shape, dtype=np.bool_) if states is None else states[seen] != DRY
        covered = np.zeros(seen.shape, dtype=np.bool_)
        if states is not None and cull_covered_terrain:
            covered = states[seen] == WET
        terrain, water = [], []
        for number in range(tiling.level_count):
            at_level = seen_level == number
            terrain.append(instances[at_level & ~covered])
            water.append(instances[at_level & has_water])
        stats = LodStats(
            terrain_triangles=count_triangles(tiling, instances[~covered], seen_level[~covered]),
            water_triangles=count_triangles(tiling, instances[has_water], seen_level[has_water]),
            terrain_blocks=int(seen.size - covered.sum()),
            water_blocks=int(has_water.sum()),
            culled_blocks=int(tiling.block_count - seen.size),
            covered_blocks=int(covered.sum()),
        )
        all_levels = np.zeros(tiling.block_count, dtype=np.uint8)
        all_levels[blocks] = level
        all_visible = np.zeros(tiling.block_count, dtype=np.bool_)
        all_visible[seen] = True
        return Selection(all_levels, all_visible, tuple(terrain), tuple(water), *reach, stats)
