"""Ghost cells: the water and the bed around the grid, filled before every step.

A wall reflects depth, tangential velocity and bed, and turns the normal velocity round. At every other edge
the bed goes on level, and both ghost cells hold the state at the edge (see `edge_states`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_DT
from solver_service.numerics.edge_kernels import EdgeSegments, face_cell
from solver_service.numerics.edge_states import (
    EDGE_DISCHARGE,
    EDGE_OPEN,
    EDGE_STAGE,
    discharge_state,
    edge_state,
    normal_depth_state,
    open_state,
    stage_state,
)
from solver_service.numerics.fields import GHOSTS, TILE, FloatRaster
from solver_service.numerics.friction import GRAVITY
from solver_service.numerics.warp_modules import SUPPORT_MODULE


@wp.func
def state_at_face(
    edge: int,
    face: int,
    h: float,
    u: float,
    z: float,
    drag: float,
    dx: float,
    s: EdgeSegments,
) -> edge_state:
    """State at a face of a segment that is no wall, from the cell inside; `u` is outwards [m/s]."""
    k = s.segment[edge, face]
    state = edge_state(h, u, 0.0)
    if s.kind[k] == EDGE_OPEN:
        state = open_state(h, u, s.rest_h[edge, face], s.rest_u[edge, face])
    elif s.kind[k] == EDGE_STAGE:
        state = stage_state(h, u, wp.float32(s.level[k] - wp.float64(z)))
    elif s.kind[k] == EDGE_DISCHARGE:
        total = wp.float64(0.0)
        for c in range(s.first_chunk[k], s.first_chunk[k + 1]):
            total = total + s.chunk_weight[c]
        q = wp.float64(0.0)
        if total > wp.float64(0.0):
            q = s.due[k] * wp.float64(s.weight[edge, face]) / (total * wp.float64(dx))
        state = discharge_state(h, u, wp.float32(q))
    else:
        state = normal_depth_state(h, u, drag, s.slope[k])
    return state


@wp.kernel(module=SUPPORT_MODULE)
def fill_ghost_cells(
    clock: wp.array(dtype=wp.float64),
    ghosts: wp.array(dtype=wp.int32),
    z: wp.array2d(dtype=wp.float32),
    drag: wp.array2d(dtype=wp.float32),
    dx: float,
    nrows: int,
    ncols: int,
    s: EdgeSegments,
    # outputs
    h: wp.array2d(dtype=wp.float32),
    u: wp.array2d(dtype=wp.float32),
    v: wp.array2d(dtype=wp.float32),
    wave_slots: wp.array(dtype=wp.float32),
):
    """Fill the listed ghost cells from the cells inside.

    Args:
        clock: see `clock_kernels`.
        ghosts: flat padded numbers of the ghost cells to fill.
        z: bed [m], padded.
        drag: g n^2 [m^(1/3)], padded.
        dx: cell side [m].
        nrows: grid rows.
        ncols: grid columns.
        s: edge segments.
        h: depth [m], padded.
        u: velocity [m/s], padded.
        v: velocity [m/s], padded.
        wave_slots: largest wave speed seen at edges that bring water [m/s], any slot.
    """
    flat = ghosts[wp.tid()]
    i = flat // (ncols + 4)
    j = flat % (ncols + 4)
    row = i - 2
    col = j - 2
    # The mirror image of the ghost cell; in a corner, of both edges.
    from_row = wp.clamp(wp.where(row < 0, -1 - row, row), 0, nrows - 1)
    from_col = wp.clamp(wp.where(col < 0, -1 - col, col), 0, ncols - 1)
    if row >= nrows:
        from_row = wp.max(2 * nrows - 1 - row, 0)
    if col >= ncols:
        from_col = wp.max(2 * ncols - 1 - col, 0)
    h_in = h[from_row + 2, from_col + 2]
    u_in = u[from_row + 2, from_col + 2]
    v_in = v[from_row + 2, from_col + 2]
    beside_x = col < 0 or col >= ncols
    beside_y = row < 0 or row >= nrows
    edge_x = wp.where(col < 0, 0, 1)
    edge_y = wp.where(row < 0, 2, 3)
    # In a corner, the mirror image in the wall of what stands beyond the other edge: walls stay tight.
    by_x = beside_x
    if beside_x and beside_y and s.segment[edge_x, from_row] < 0:
        by_x = False
    edge = wp.where(by_x, edge_x, edge_y)
    face = wp.where(by_x, from_row, from_col)
    sign = wp.where(edge == 0 or edge == 2, -1.0, 1.0)
    state = edge_state(0.0, 0.0, 1.0)
    if s.segment[edge, face] >= 0:
        cell = face_cell(edge, face, nrows, ncols)
        a = cell[0]
        b = cell[1]
        normal = wp.where(by_x, u[a, b], v[a, b])
        state = state_at_face(edge, face, h[a, b], sign * normal, z[a, b], drag[a, b], dx, s)
        if state[2] == 0.0:
            along = wp.where(state[1] > 0.0, wp.where(by_x, v[a, b], u[a, b]), 0.0)
            h_in = state[0]
            u_in = wp.where(by_x, sign * state[1], along)
            v_in = wp.where(by_x, along, sign * state[1])
            kind = s.kind[s.segment[edge, face]]
            if (kind == EDGE_STAGE or kind == EDGE_DISCHARGE) and clock[CLOCK_DT] > wp.float64(0.0):
                wave = wp.abs(state[1]) + wp.sqrt(GRAVITY * state[0])
                wp.atomic_max(wave_slots, flat % wave_slots.shape[0], wave)
    if state[2] != 0.0:
        if by_x:
            u_in = -u_in
        else:
            v_in = -v_in
    if beside_x and beside_y:
        if by_x:
            v_in = -v_in
        else:
            u_in = -u_in
    h[i, j] = h_in
    u[i, j] = u_in
    v[i, j] = v_in


def ghost_cells(nrows: int, ncols: int) -> npt.NDArray[np.int32]:
    """Flat padded numbers of all ghost cells."""
    ring = np.ones((nrows + 2 * GHOSTS, ncols + 2 * GHOSTS), bool)
    ring[GHOSTS:-GHOSTS, GHOSTS:-GHOSTS] = False
    return np.flatnonzero(ring).astype(np.int32)


def ghost_tiles(ghosts: npt.NDArray[np.int32], nrows: int, ncols: int) -> npt.NDArray[np.int64]:
    """Compute tile, row-major, that each ghost cell lies at."""
    rows, cols = np.divmod(ghosts, ncols + 2 * GHOSTS)
    tile_rows = np.clip(rows - GHOSTS, 0, nrows - 1) // TILE
    tile_cols = np.clip(cols - GHOSTS, 0, ncols - 1) // TILE
    return (tile_rows * -(-ncols // TILE) + tile_cols).astype(np.int64)


def pad_bed(z_b: FloatRaster, segment: npt.NDArray[np.int32]) -> FloatRaster:
    """Bed with ghost cells: mirrored at walls, continued level at other edges."""
    return _pad(z_b, segment, lambda inside: inside)


def pad_drag(drag: FloatRaster, segment: npt.NDArray[np.int32]) -> FloatRaster:
    """G n^2 with ghost cells: mirrored at walls, none at other edges, whose state no friction may change."""
    return _pad(drag, segment, np.zeros_like)


def _pad(
    raster: FloatRaster,
    segment: npt.NDArray[np.int32],
    beyond: Callable[[FloatRaster], FloatRaster],
) -> FloatRaster:
    """Mirror a raster at walls; elsewhere both ghost cells hold what `beyond` makes of the edge cell."""
    nrows, ncols = raster.shape
    padded = np.pad(raster, GHOSTS, mode="symmetric").astype(np.float32)
    inside = (slice(GHOSTS, GHOSTS + nrows), slice(GHOSTS, GHOSTS + ncols))
    edges = (
        (padded[inside[0], :GHOSTS].T, raster[:, 0]),
        (padded[inside[0], -GHOSTS:].T, raster[:, -1]),
        (padded[:GHOSTS, inside[1]], raster[0]),
        (padded[-GHOSTS:, inside[1]], raster[-1]),
    )
    for (ghosts, cells), owners in zip(edges, segment, strict=True):
        passable = owners[: cells.size] >= 0
        ghosts[:, passable] = beyond(cells[passable])
    return padded
