"""What the edges ask for in a step, and what has passed them.

Before the step: the level of each stage, and for each discharge the volume that is due,

    due = V(t + dt) - V(t) + [V(t) - passed(t)] / 2,      V the exact integral of the series

so that what a Riemann solver lets through more or less than asked is made up for and the volume that has
entered never drifts from V. It is spread over the cells of the segment in proportion to their conveyance
h^(5/3) / n; no depth counts for less than its share of the critical flow of the same discharge over the bare
bed, so that the first water takes the lowest cells and films on banks take next to nothing. Water that is
to leave but is not there is forgiven and booked as unmet. The series are looked up one step ahead too, so
that a sudden rise does not meet a giant step.

After the step: how much came in and went out through each face. A ghost cell whose neighbour along the edge
belongs to another segment is predicted a little off the mirror image: what came in through an edge that only
lets out, and what passed a wall beside a segment, is put back at once, so that the one is never a source and
the other tight.

Cells of an edge are dealt to threads in chunks. Sums are float64 in a fixed order.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_BEFORE, CLOCK_DT, CLOCK_TIME
from solver_service.numerics.edge_states import (
    EDGE_DISCHARGE,
    EDGE_NORMAL_DEPTH,
    EDGE_OPEN,
    EDGE_STAGE,
    EDGE_WALL,
)
from solver_service.numerics.fields import Fields
from solver_service.numerics.friction import GRAVITY, inverse_cube_root
from solver_service.numerics.warp_modules import SUPPORT_MODULE

RATING_LENGTH = 33
"""Points of the rating of critical flow."""

RATING_LAST = wp.constant(RATING_LENGTH - 1)


@wp.struct
class EdgeSegments:
    """The segments that are not walls, and the faces they own; edges are west, east, south, north."""

    segment: wp.array2d(dtype=wp.int32)
    """Segment of each face, -1 for walls, [4, longest edge]."""
    kind: wp.array(dtype=wp.int32)
    """See `edge_states`, [segments]."""
    slope: wp.array(dtype=wp.float32)
    """Of normal depths [1]."""
    series: wp.array(dtype=wp.int32)
    """Where each series begins in the joined arrays, [segments + 1]."""
    times: wp.array(dtype=wp.float64)
    values: wp.array(dtype=wp.float64)
    volumes: wp.array(dtype=wp.float64)
    """Integral of the series from time 0 to `times`."""
    rating_level: wp.array2d(dtype=wp.float32)
    """Levels of discharges [m], [segments, RATING_LENGTH]; the first is the lowest bed, of stages too."""
    rating_discharge: wp.array2d(dtype=wp.float32)
    """Critical discharge over the bare bed at these levels [m3/s]."""
    chunk: wp.array2d(dtype=wp.int32)
    """Edge, first face, one past the last, segment; [chunks, 4]. Walls beside segments stand at the end."""
    first_chunk: wp.array(dtype=wp.int32)
    """First chunk of each segment, [segments + 1]."""
    rest_h: wp.array2d(dtype=wp.float32)
    """Depth at the start [m], [4, longest edge]."""
    rest_u: wp.array2d(dtype=wp.float32)
    """Outward velocity at the start [m/s], not negative."""
    level: wp.array(dtype=wp.float64)
    """Water level of a stage [m]; level of critical flow of a discharge."""
    due: wp.array(dtype=wp.float64)
    """Discharge into the domain that the step shall bring [m3/s]."""
    unmet: wp.array(dtype=wp.float64)
    """Volume that was to leave and was not there [m3], not positive."""
    weight: wp.array2d(dtype=wp.float32)
    """Share of each face in its segment's discharge before normalisation, [4, longest edge]."""
    chunk_weight: wp.array(dtype=wp.float64)
    """Their sums."""
    chunk_flow: wp.array(dtype=wp.float64)
    """Sums of `edge_flow` [m], outwards."""
    flow_seen: wp.array2d(dtype=wp.float64)
    """`edge_flow` when it was booked last [m], [4, longest edge]."""
    came: wp.array2d(dtype=wp.float64)
    """Depth that came in through each face [m]."""


@wp.func
def series_entry(s: EdgeSegments, k: int, time: wp.float64) -> int:
    """Entry of the series of segment k at or before a time; the first one also before it."""
    low = s.series[k]
    high = s.series[k + 1] - 1
    while low < high:
        middle = (low + high + 1) // 2
        if s.times[middle] <= time:
            low = middle
        else:
            high = middle - 1
    return low


@wp.func
def value_at(s: EdgeSegments, k: int, time: wp.float64) -> wp.float64:
    """Series of segment k, linear, held outside its times."""
    n = series_entry(s, k, time)
    value = s.values[n]
    if time > s.times[n] and n + 1 < s.series[k + 1]:
        part = (time - s.times[n]) / (s.times[n + 1] - s.times[n])
        value = value + part * (s.values[n + 1] - value)
    return value


@wp.func
def volume_at(s: EdgeSegments, k: int, time: wp.float64) -> wp.float64:
    """Integral of the series of segment k from time 0."""
    n = series_entry(s, k, time)
    part = time - s.times[n]
    mean = s.values[n]
    if part > wp.float64(0.0):
        mean = wp.float64(0.5) * (mean + value_at(s, k, time))
    return s.volumes[n] + part * mean


@wp.func
def critical_level(s: EdgeSegments, k: int, discharge: wp.float64) -> float:
    """Level of the critical flow of a discharge over the bare bed of segment k [m]."""
    q = wp.float32(discharge)
    n = int(0)
    while n + 1 < RATING_LAST and s.rating_discharge[k, n + 1] < q:
        n += 1
    rise = s.rating_discharge[k, n + 1] - s.rating_discharge[k, n]
    part = (q - s.rating_discharge[k, n]) / wp.max(rise, 1.0e-12)
    level = s.rating_level[k, n] + part * (s.rating_level[k, n + 1] - s.rating_level[k, n])
    return wp.max(level, s.rating_level[k, 0])


@wp.kernel(module=SUPPORT_MODULE)
def decide_edge_values(
    clock: wp.array(dtype=wp.float64),
    cell_area: wp.float64,
    s: EdgeSegments,
    # outputs
    wave_slots: wp.array(dtype=wp.float32),
):
    """Set level, discharge due and what is unmet of every segment for the step of the clock.

    Args:
        clock: see `clock_kernels`.
        cell_area: dx^2 [m2].
        s: the segments.
        wave_slots: largest wave speed that the next step may meet [m/s], any slot.
    """
    k = wp.tid()
    before = clock[CLOCK_BEFORE]
    after = clock[CLOCK_TIME]
    dt = clock[CLOCK_DT]
    if s.kind[k] == EDGE_STAGE:
        s.level[k] = value_at(s, k, wp.float64(0.5) * (before + after))
        if dt > wp.float64(0.0):
            depth = wp.float32(value_at(s, k, after + dt)) - s.rating_level[k, 0]
            wp.atomic_max(wave_slots, k % wave_slots.shape[0], wp.sqrt(GRAVITY * wp.max(depth, 0.0)))
    if s.kind[k] == EDGE_DISCHARGE and dt > wp.float64(0.0):
        flow = wp.float64(0.0)
        for c in range(s.first_chunk[k], s.first_chunk[k + 1]):
            flow = flow + s.chunk_flow[c]
        begun = volume_at(s, k, before)
        asked = volume_at(s, k, after) - begun
        owed = begun - s.unmet[k] + flow * cell_area
        if asked <= wp.float64(0.0) and owed < asked:
            s.unmet[k] = s.unmet[k] + (owed - asked)
            owed = asked
        due = asked + wp.float64(0.5) * owed
        if asked > wp.float64(0.0):
            due = wp.max(due, wp.float64(0.0))
        if asked < wp.float64(0.0):
            due = wp.min(due, wp.float64(0.0))
        due = due / dt
        s.due[k] = due
        s.level[k] = wp.float64(critical_level(s, k, due))
        depth = critical_level(s, k, value_at(s, k, after + dt)) - s.rating_level[k, 0]
        wp.atomic_max(wave_slots, k % wave_slots.shape[0], 2.0 * wp.sqrt(GRAVITY * depth))


@wp.func
def face_cell(edge: int, k: int, nrows: int, ncols: int) -> wp.vec2i:
    """Padded row and column of the cell inside face k of an edge."""
    i = k + 2
    j = int(2)
    if edge == 1:
        j = ncols + 1
    if edge == 2:
        i = 2
        j = k + 2
    if edge == 3:
        i = nrows + 1
        j = k + 2
    return wp.vec2i(i, j)


@wp.kernel(module=SUPPORT_MODULE)
def weigh_edge_cells(
    h: wp.array2d(dtype=wp.float32),
    z: wp.array2d(dtype=wp.float32),
    drag: wp.array2d(dtype=wp.float32),
    depth_dry: float,
    nrows: int,
    ncols: int,
    s: EdgeSegments,
):
    """Set the shares of the faces of discharge segments, and their sums by chunk.

    Args:
        h: depth [m], padded.
        z: bed [m], padded.
        drag: g n^2 [m^(1/3)], padded.
        depth_dry: depth below which water does not leave [m].
        nrows: grid rows.
        ncols: grid columns.
        s: the segments.
    """
    c = wp.tid()
    edge = s.chunk[c, 0]
    k = s.chunk[c, 3]
    kind = EDGE_WALL
    if k < s.first_chunk.shape[0] - 1:
        kind = s.kind[k]
    if kind == EDGE_DISCHARGE:
        total = wp.float64(0.0)
        for face in range(s.chunk[c, 1], s.chunk[c, 2]):
            cell = face_cell(edge, face, nrows, ncols)
            i = cell[0]
            j = cell[1]
            depth = h[i, j]
            if s.due[k] > wp.float64(0.0):
                depth = wp.max(depth, wp.float32(s.level[k] - wp.float64(z[i, j])))
            elif depth <= depth_dry:
                depth = 0.0
            weight = float(0.0)
            if depth > 0.0:
                # h^(5/3) / n but for a constant; a smooth bed counts as n = 0.001.
                weight = depth * depth * inverse_cube_root(depth) / wp.sqrt(wp.max(drag[i, j], 1.0e-5))
            s.weight[edge, face] = weight
            total = total + wp.float64(weight)
        s.chunk_weight[c] = total


@wp.kernel(module=SUPPORT_MODULE)
def book_edge_flow(f: Fields, axis: int, nrows: int, ncols: int, s: EdgeSegments):
    """Book what has passed the faces since the last booking; put back what must not pass.

    Args:
        f: rasters after the step.
        axis: 0 for the western and eastern edge, 1 for the others: a corner cell is changed by one at a time.
        nrows: grid rows.
        ncols: grid columns.
        s: the segments.
    """
    c = wp.tid()
    edge = s.chunk[c, 0]
    if edge // 2 != axis:
        return
    k = s.chunk[c, 3]
    kind = EDGE_WALL
    if k < s.first_chunk.shape[0] - 1:
        kind = s.kind[k]
    total = wp.float64(0.0)
    for face in range(s.chunk[c, 1], s.chunk[c, 2]):
        seen = s.flow_seen[edge, face]
        flow = f.edge_flow[edge, face]
        lets_out = kind == EDGE_OPEN or kind == EDGE_NORMAL_DEPTH
        if (lets_out and flow < seen) or (kind == EDGE_WALL and flow != seen):
            cell = face_cell(edge, face, nrows, ncols)
            h = f.h_out[cell[0], cell[1]]
            kept = wp.max(h + wp.float32(flow - seen), 0.0)
            f.h_out[cell[0], cell[1]] = kept
            flow = flow + (wp.float64(h) - wp.float64(kept))
            f.edge_flow[edge, face] = flow
        s.came[edge, face] = s.came[edge, face] + wp.max(seen - flow, wp.float64(0.0))
        s.flow_seen[edge, face] = flow
        total = total + flow
    s.chunk_flow[c] = total
