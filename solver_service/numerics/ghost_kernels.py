"""Ghost cells: the water and the bed around the grid, filled before every step.

A wall reflects surface, tangential velocity and bed, and turns the normal velocity round. At every other
edge both ghost cells hold the state at the edge (see `edge_states`). A bed that falls towards the edge goes
on falling behind it, and one that rises towards a discharge goes on rising. Still water goes on level over
that bed, water in balance with friction or that falls off keeps its depth, and in between the surface falls
by the friction slope: a lake stays at rest, and uniform flow stays uniform.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_DT
from solver_service.numerics.edge_kernels import EdgeSegments, face_cell
from solver_service.numerics.edge_states import (
    ACTS_AS_WALL,
    EDGE_DISCHARGE,
    EDGE_OPEN,
    EDGE_STAGE,
    PASSES,
    discharge_state,
    edge_state,
    normal_depth_state,
    open_state,
    stage_state,
)
from solver_service.numerics.fields import GHOSTS, TILE, FloatRaster
from solver_service.numerics.friction import GRAVITY, inverse_cube_root
from solver_service.numerics.warp_modules import SUPPORT_MODULE

LEVEL_ROUNDING = wp.constant(6.0e-8)
"""Rounding of a level that was given in single precision [1]."""


@wp.func
def state_at_face(
    edge: int,
    face: int,
    h: float,
    u: float,
    z: float,
    drag: float,
    dx: float,
    friction_drop: float,
    s: EdgeSegments,
) -> edge_state:
    """State at a face of a segment that is no wall, from the cell inside; `u` is outwards [m/s].

    `friction_drop` is the fall of the surface per cell by friction [m].
    """
    k = s.segment[edge, face]
    state = edge_state(h, u, PASSES)
    if s.kind[k] == EDGE_OPEN:
        state = open_state(h, u, s.rest_h[edge, face], s.rest_u[edge, face])
    elif s.kind[k] == EDGE_STAGE:
        depth = wp.float32(s.level[k] - wp.float64(z)) + 0.5 * friction_drop
        state = stage_state(h, u, depth, LEVEL_ROUNDING * wp.abs(wp.float32(s.level[k])))
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
    dx: float,
    nrows: int,
    ncols: int,
    s: EdgeSegments,
    # outputs
    drag: wp.array2d(dtype=wp.float32),
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
        dx: cell side [m].
        nrows: grid rows.
        ncols: grid columns.
        s: edge segments.
        drag: g n^2 [m^(1/3)], padded; none in ghost cells whose surface does not fall.
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
    if h_in > 0.0:
        h_in = wp.max(h_in + (z[from_row + 2, from_col + 2] - z[i, j]), 0.0)
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
    state = edge_state(0.0, 0.0, ACTS_AS_WALL)
    if s.segment[edge, face] >= 0:
        cell = face_cell(edge, face, nrows, ncols)
        a = cell[0]
        b = cell[1]
        normal = sign * wp.where(by_x, u[a, b], v[a, b])
        step = wp.int32(sign)
        drop = z[a, b] - wp.where(by_x, z[a, b + step], z[a + step, b])
        friction_drop = float(0.0)
        if h[a, b] > 0.0:
            root = inverse_cube_root(wp.max(h[a, b], 1.0e-6))
            slope = drag[a, b] * (root * root) * (root * root) * wp.abs(normal) * normal / GRAVITY
            friction_drop = wp.clamp(slope * dx, wp.min(drop, 0.0), wp.max(drop, 0.0))
        elif drop < 0.0:
            friction_drop = drop
        state = state_at_face(edge, face, h[a, b], normal, z[a, b], drag[a, b], dx, friction_drop, s)
        drag[i, j] = drag[a, b]
        if state[2] != ACTS_AS_WALL:
            drag[i, j] = wp.where(drop != 0.0, drag[a, b], 0.0)
            along = wp.where(state[1] > 0.0, wp.where(by_x, v[a, b], u[a, b]), 0.0)
            h_in = state[0]
            if state[2] == PASSES and h_in > 0.0 and drop != 0.0:
                level = h_in + (z[a, b] - z[i, j]) * (1.0 - friction_drop / drop)
                h_in = wp.max(level, 0.5 * h_in)
            u_in = wp.where(by_x, sign * state[1], along)
            v_in = wp.where(by_x, along, sign * state[1])
            kind = s.kind[s.segment[edge, face]]
            if (kind == EDGE_STAGE or kind == EDGE_DISCHARGE) and clock[CLOCK_DT] > wp.float64(0.0):
                wave = wp.abs(state[1]) + wp.sqrt(GRAVITY * state[0])
                wp.atomic_max(wave_slots, flat % wave_slots.shape[0], wave)
    if state[2] == ACTS_AS_WALL:
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


def pad_bed(
    z_b: FloatRaster,
    segment: npt.NDArray[np.int32],
    fall_max: npt.NDArray[np.float32],
    rise_max: npt.NDArray[np.float32],
) -> FloatRaster:
    """Bed with ghost cells: mirrored at walls, continued at other edges.

    Args:
        z_b: bed [m], [nrows, ncols].
        segment: segment of each face, -1 for walls, [4, longest edge].
        fall_max: largest fall towards the edge that goes on behind it [m per cell], same shape; what falls
            more goes on level.
        rise_max: largest rise, alike.
    """
    nrows, ncols = z_b.shape
    padded = np.pad(z_b, GHOSTS, mode="symmetric").astype(np.float32)
    inside = (slice(GHOSTS, GHOSTS + nrows), slice(GHOSTS, GHOSTS + ncols))
    edges = (
        (padded[inside[0], GHOSTS - 1 :: -1].T, z_b[:, 0], z_b[:, 1]),
        (padded[inside[0], -GHOSTS:].T, z_b[:, -1], z_b[:, -2]),
        (padded[GHOSTS - 1 :: -1, inside[1]], z_b[0], z_b[1]),
        (padded[-GHOSTS:, inside[1]], z_b[-1], z_b[-2]),
    )
    for number, (ghosts, cell, inner) in enumerate(edges):
        passable = segment[number, : cell.size] >= 0
        fall = inner - cell
        goes_on = (fall <= fall_max[number, : cell.size]) & (-fall <= rise_max[number, : cell.size])
        fall = np.where(goes_on, fall, np.float32(0.0))
        for layer in range(GHOSTS):
            ghosts[layer, passable] = (cell - (layer + 1) * fall)[passable]
    for row in (0, nrows - 1):  # corners are the mirror images of what stands beside them
        rows = slice(0, GHOSTS) if row == 0 else slice(nrows + GHOSTS, None)
        for edge, west in ((0, True), (1, False)):
            cols = slice(0, GHOSTS) if west else slice(ncols + GHOSTS, None)
            if segment[edge, row] < 0:
                beside = padded[rows, inside[1]]
                padded[rows, cols] = beside[:, 1::-1] if west else beside[:, : -GHOSTS - 1 : -1]
            else:
                beside = padded[inside[0], cols]
                padded[rows, cols] = beside[1::-1] if row == 0 else beside[: -GHOSTS - 1 : -1]
    return padded
