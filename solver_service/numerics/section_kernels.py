"""What passes a section in a step: the fluxes of its faces, computed once more.

The state before a step still stands in one of the two buffers, ghost cells included, and the same functions
give the same floats, over weirs too: the sum is what the solver moved, bit for bit, while the step itself
knows nothing of sections. Faces are dealt to threads in chunks; sums are float64 in a fixed order.
"""

import warp as wp

from solver_service.numerics.clock_kernels import CLOCK_BEFORE, CLOCK_DT, CLOCK_TIME
from solver_service.numerics.fields import Fields, Scheme
from solver_service.numerics.step_kernels import predict_at
from solver_service.numerics.warp_modules import STRUCTURE_MODULE
from solver_service.numerics.weir_kernels import side_flux

PEAK_NONE = wp.constant(-1.0)
"""Time of a peak that has not been."""


@wp.struct
class SectionFaces:
    """The faces of all sections, one section after the other."""

    row: wp.array(dtype=wp.int32)
    """Row of the cell south or west of each face, [faces]."""
    col: wp.array(dtype=wp.int32)
    """Column of it."""
    is_northern: wp.array(dtype=wp.int32)
    """1 for the northern side of the cell, 0 for the eastern."""
    sign: wp.array(dtype=wp.float32)
    """1 where east or north is to the right of the line, else -1."""
    wall: wp.array(dtype=wp.int32)
    """Number of the weir at each face, -1 for none; see `weir_kernels`."""
    share: wp.array(dtype=wp.float32)
    """Length of the line that each face stands for, in sides."""
    chunk: wp.array(dtype=wp.int32)
    """First face of each chunk, [chunks + 1]."""
    first_chunk: wp.array(dtype=wp.int32)
    """First chunk of each section, [sections + 1]."""
    chunk_moved: wp.array(dtype=wp.float64)
    """Depth that the faces of each chunk moved to the right in the step [m]."""
    totals: wp.array2d(dtype=wp.float64)
    """Volume passed [m3], peak discharge [m3/s], its time [s]; [sections, 3]."""


@wp.kernel(module=STRUCTURE_MODULE)
def measure_sections(
    f: Fields,
    scheme: Scheme,
    clock: wp.array(dtype=wp.float64),
    crests: wp.array(dtype=wp.float32),
    coefficients: wp.array(dtype=wp.float32),
    between: wp.array(dtype=wp.int32),
    s: SectionFaces,
):
    """Set what each chunk of faces moved in the step from `h` to `h_out`.

    Args:
        f: rasters.
        scheme: scheme.
        clock: see `clock_kernels`.
        crests: crest of each wall [m]; this and the next two see `weir_kernels`.
        coefficients: C of each wall [m^0.5/s].
        between: bits of each wall.
        s: the faces.
    """
    c = wp.tid()
    dt = wp.float32(clock[CLOCK_DT])
    total = wp.float64(0.0)
    if dt > 0.0:
        half_dt = 0.5 * dt
        r = dt / scheme.dx
        for k in range(s.chunk[c], s.chunk[c + 1]):
            i = s.row[k] + 2
            j = s.col[k] + 2
            is_x = s.is_northern[k] == 0
            near = predict_at(f, scheme, i, j, half_dt)
            far = predict_at(f, scheme, i + s.is_northern[k], j + 1 - s.is_northern[k], half_dt)
            flux = side_flux(f, scheme, near, far, i, j, is_x, s.wall[k], crests, coefficients, between, r)
            total = total + wp.float64(s.sign[k] * flux[0])
    s.chunk_moved[c] = total


@wp.kernel(module=STRUCTURE_MODULE)
def book_sections(
    f: Fields,
    scheme: Scheme,
    clock: wp.array(dtype=wp.float64),
    interval: wp.float64,
    s: SectionFaces,
    # outputs
    cursor: wp.array2d(dtype=wp.int32),
    records: wp.array3d(dtype=wp.float64),
):
    """Add up what each section moved, and record it for every record time that the step passed.

    Args:
        f: rasters.
        scheme: scheme.
        clock: see `clock_kernels`.
        interval: time between records [s].
        s: the faces.
        cursor: number of the next record, and of the first in `records`; [sections, 2].
        records: discharge [m3/s], volume [m3] and wet area [m2]; [capacity, sections, 3].
    """
    k = wp.tid()
    before = clock[CLOCK_BEFORE]
    after = clock[CLOCK_TIME]
    dt = clock[CLOCK_DT]
    if dt <= wp.float64(0.0):
        return
    dx = wp.float64(scheme.dx)
    moved = wp.float64(0.0)
    for c in range(s.first_chunk[k], s.first_chunk[k + 1]):
        moved = moved + s.chunk_moved[c]
    moved = moved * dx * dx
    discharge = moved / dt
    passed = s.totals[k, 0]
    if wp.abs(discharge) > wp.abs(s.totals[k, 1]):
        s.totals[k, 1] = discharge
        s.totals[k, 2] = after
    s.totals[k, 0] = passed + moved
    n = cursor[k, 0]
    while wp.float64(n) * interval <= after:
        part = (wp.float64(n) * interval - before) / (after - before)
        w = wp.float32(part)
        area = wp.float64(0.0)
        for c in range(s.chunk[s.first_chunk[k]], s.chunk[s.first_chunk[k + 1]]):
            i = s.row[c] + 2
            j = s.col[c] + 2
            a = i + s.is_northern[c]
            b = j + 1 - s.is_northern[c]
            h = f.h[i, j] + w * (f.h_out[i, j] - f.h[i, j])
            h = h + (f.h[a, b] + w * (f.h_out[a, b] - f.h[a, b]))
            area = area + wp.float64(s.share[c] * h)
        first = n - cursor[k, 1]
        records[first, k, 0] = discharge
        records[first, k, 1] = passed + part * moved
        records[first, k, 2] = wp.float64(0.5) * area * dx
        n += 1
    cursor[k, 0] = n
