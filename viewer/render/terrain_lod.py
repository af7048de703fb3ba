"""Keeps block errors, bounds and the selector in step with the heightfield."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from viewer.lod import (
    BlockSelector,
    BlockTiling,
    Selection,
    SwitchTable,
    block_bounds,
    block_errors,
    edge_errors,
)
from viewer.render.frame_inputs import EditOverlay, FrameInputs, same_marks
from viewer.world.coordinates import WorldFrame
from viewer.world.heightfield import Heightfield, Rect

__all__ = ["TerrainLod"]

_PARTIAL, _WET = 1, 2


class TerrainLod:
    """Level of detail of one heightfield."""

    def __init__(self, heightfield: Heightfield, tiling: BlockTiling) -> None:
        """Compute all errors."""
        self._heightfield = heightfield
        self.tiling = tiling
        self._bounds = block_bounds(heightfield.drawn, tiling)
        errors = block_errors(heightfield.drawn, tiling)
        self._table = SwitchTable(errors, edge_errors(heightfield.drawn, tiling, errors))
        self._selector = BlockSelector(tiling, heightfield.grid.dx, self._table, self._bounds)
        self._edited: npt.NDArray[np.bool_] | None = None
        self._edits: EditOverlay | None = None

    def refresh(self, dirty: Rect) -> None:
        """Redo the errors and bounds of the blocks that hold a vertex of a rectangle of cells.

        Done before the next picture, so that no block is ever drawn coarser than its ground allows, and an
        edited block has its level of detail as any other.
        """
        tiling = self.tiling
        first_row, first_col, end_row, end_col = tiling.blocks_touching(dirty)
        if first_row >= end_row or first_col >= end_col:
            return
        # Charges go across edges: redo one ring more, and read two, of which the outer one comes out wrong.
        redone = _grown((first_row, first_col, end_row, end_col), 1, tiling)
        read = _grown(redone, 1, tiling)
        row0, row1 = int(tiling.row_start[read[0]]), int(tiling.row_end[read[2] - 1]) + 1
        col0, col1 = int(tiling.col_start[read[1]]), int(tiling.col_end[read[3] - 1]) + 1
        z = tiling.fitted(self._heightfield.drawn)[row0:row1, col0:col1]
        part = BlockTiling(z.shape[0], z.shape[1], tiling.block_size)
        errors, bounds = block_errors(z, part), block_bounds(z, part)
        charges = edge_errors(z, part, errors)
        target = (slice(redone[0], redone[2]), slice(redone[1], redone[3]))
        rows = slice(redone[0] - read[0], redone[2] - read[0])
        cols = slice(redone[1] - read[1], redone[3] - read[1])
        self._bounds.z_min[target], self._bounds.z_max[target] = (
            bounds.z_min[rows, cols],
            bounds.z_max[rows, cols],
        )
        self._table.update(errors[:, rows, cols], charges[:, rows, cols], redone)
        self._selector.refresh()

    def follow_edits(self, edits: EditOverlay | None) -> None:
        """Note which blocks hold an edited vertex: their ground may stand out of the water."""
        if same_marks(edits, self._edits):
            return
        self._edits, self._edited = edits, None
        if edits is not None:
            self._edited = self.tiling.reduce(np.logical_or, edits.sign != 0).astype(np.bool_).ravel()

    def select(
        self,
        inputs: FrameInputs,
        frame: WorldFrame,
        size: tuple[int, int],
        states: npt.NDArray[np.uint8] | None,
        depth_max: float,
    ) -> Selection:
        """Choose the blocks of a picture."""
        options = inputs.options
        if states is not None and self._edited is not None:
            # A levee may rise out of a block that is wet all over, so its ground must be drawn.
            states = np.where(self._edited & (states == _WET), _PARTIAL, states).astype(np.uint8)
        return self._selector.select(
            inputs.camera,
            frame,
            size,
            options.tau_px,
            states=states,
            depth_max=depth_max,
            water_spacing_px=options.water_spacing_px,
            partial_spacing_px=options.partial_spacing_px,
            cull=options.cull,
            cull_covered_terrain=options.cull_covered_terrain,
            classify_water=options.classify_water,
            full_mesh=options.full_mesh,
            quadtree=options.quadtree,
        )


def _grown(blocks: Rect, by: int, tiling: BlockTiling) -> Rect:
    """A rectangle of blocks with more around it, as far as there are any."""
    row0, col0, row1, col1 = blocks
    return (
        max(0, row0 - by),
        max(0, col0 - by),
        min(tiling.block_rows, row1 + by),
        min(tiling.block_cols, col1 + by),
    )
