"""The arrays of a run on its device, and the numbers of the scheme, as Warp structs.

Rasters are float32 [nrows + 4, ncols + 4]: two ghost cells surround the grid. h, u, v exist twice; a step
reads one set and writes the other. Arrival times are `NEVER` where the water has not come; those by depth
class are [class, nrows + 4, ncols + 4].
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import warp as wp

GHOSTS = 2
"""Ghost cells on each side."""

TILE = 16
"""Side of a compute tile [cells]."""

NEVER = 3.0e38
"""Arrival time of water that has not come [s]."""

FloatRaster = npt.NDArray[np.float32]

STATE_NAMES = ("h", "u", "v")
MAXIMA_NAMES = (
    "h_max",
    "h_max_time",
    "speed_max",
    "discharge_max",
    "hazard_max",
    "arrival",
    "wet_since",
    "rise_rate_max",
)


@wp.struct
class Fields:
    """One reading direction of the double buffer with everything a step touches."""

    h: wp.array2d(dtype=wp.float32)
    u: wp.array2d(dtype=wp.float32)
    v: wp.array2d(dtype=wp.float32)
    h_out: wp.array2d(dtype=wp.float32)
    u_out: wp.array2d(dtype=wp.float32)
    v_out: wp.array2d(dtype=wp.float32)
    z: wp.array2d(dtype=wp.float32)
    drag: wp.array2d(dtype=wp.float32)
    h_max: wp.array2d(dtype=wp.float32)
    h_max_time: wp.array2d(dtype=wp.float32)
    speed_max: wp.array2d(dtype=wp.float32)
    discharge_max: wp.array2d(dtype=wp.float32)
    hazard_max: wp.array2d(dtype=wp.float32)
    arrival: wp.array2d(dtype=wp.float32)
    wet_since: wp.array2d(dtype=wp.float32)
    rise_rate_max: wp.array2d(dtype=wp.float32)
    class_depths: wp.array(dtype=wp.float32)
    class_arrival: wp.array3d(dtype=wp.float32)
    edge_flow: wp.array2d(dtype=wp.float64)


@wp.struct
class Scheme:
    """Numbers that hold for a whole run; see `SolverParams`."""

    dx: wp.float32
    theta: wp.float32
    hancock: wp.float32
    contact: wp.float32
    depth_dry: wp.float32
    depth_film: wp.float32
    depth_cfl: wp.float32
    eddy: wp.float32
    courant: wp.float32
    depth_arrival: wp.float32
    nrows: wp.int32
    ncols: wp.int32


class FieldStore:
    """Owns the arrays and knows which of the two states is current.

    Args:
        nrows: grid rows.
        ncols: grid columns.
        device: Warp device name.
        arrival_depths: depth classes whose arrival times are kept [m].
    """

    def __init__(self, nrows: int, ncols: int, device: str, arrival_depths: tuple[float, ...] = ()) -> None:
        self.nrows, self.ncols, self.device = nrows, ncols, device
        shape = (nrows + 2 * GHOSTS, ncols + 2 * GHOSTS)
        names = [name + side for name in STATE_NAMES for side in ("0", "1")]
        names += ["z", "drag", *MAXIMA_NAMES]
        self.arrays = {name: wp.zeros(shape, dtype=wp.float32, device=device) for name in names}
        self.edge_flow = wp.zeros((4, max(nrows, ncols)), dtype=wp.float64, device=device)
        self.arrival_depths = arrival_depths
        self.class_depths = wp.array(arrival_depths, dtype=wp.float32, device=device)
        self.class_arrival = wp.zeros((len(arrival_depths), *shape), dtype=wp.float32, device=device)
        self.parity = 0
        self.fields = (self._view("0", "1"), self._view("1", "0"))

    def _view(self, current: str, following: str) -> Fields:
        fields = Fields()
        for name in STATE_NAMES:
            setattr(fields, name, self.arrays[name + current])
            setattr(fields, name + "_out", self.arrays[name + following])
        for name in ("z", "drag", *MAXIMA_NAMES):
            setattr(fields, name, self.arrays[name])
        fields.edge_flow = self.edge_flow
        fields.class_depths, fields.class_arrival = self.class_depths, self.class_arrival
        return fields

    def current(self, name: str) -> wp.array:
        """The padded device array of `h`, `u` or `v` that holds the present state."""
        return self.arrays[name + str(self.parity)]

    def previous(self, name: str) -> wp.array:
        """The state array a step before the current one (only where the last step wrote)."""
        return self.arrays[name + str(1 - self.parity)]

    def read(self, name: str) -> FloatRaster:
        """Copy of a raster without ghost cells, [nrows, ncols]; state names give the current state."""
        array = self.current(name) if name in STATE_NAMES else self.arrays[name]
        return np.array(array.numpy()[GHOSTS:-GHOSTS, GHOSTS:-GHOSTS], order="C")

    def write(self, name: str, values: npt.ArrayLike) -> None:
        """Set a raster without ghost cells; a state name sets both states.

        Ghost cells of the state are filled before every step; the other rasters need none.
        """
        inside = slice(GHOSTS, -GHOSTS)
        targets = (name + "0", name + "1") if name in STATE_NAMES else (name,)
        if self.device == "cpu":
            for target in targets:
                self.arrays[target].numpy()[inside, inside] = values
        else:
            padded = np.zeros((self.nrows + 2 * GHOSTS, self.ncols + 2 * GHOSTS), np.float32)
            padded[inside, inside] = values
            self.write_padded(name, padded)

    def write_padded(self, name: str, padded: FloatRaster) -> None:
        """Set a raster with its ghost cells; a state name sets both states."""
        targets = (name + "0", name + "1") if name in STATE_NAMES else (name,)
        for target in targets:
            self.arrays[target].assign(padded)

    def read_class_arrival(self) -> npt.NDArray[np.float32]:
        """Copy of the arrival times by depth class without ghost cells, [class, nrows, ncols]."""
        return np.array(self.class_arrival.numpy()[:, GHOSTS:-GHOSTS, GHOSTS:-GHOSTS], order="C")

    def write_class_arrival(self, values: npt.NDArray[np.float32]) -> None:
        """Set the arrival times by depth class, [class, nrows, ncols]."""
        if self.arrival_depths:
            self.class_arrival.assign(np.pad(values, ((0, 0), (GHOSTS, GHOSTS), (GHOSTS, GHOSTS))))

    def interior(self, name: str) -> FloatRaster:
        """View (CPU) or copy (CUDA) of a raster without ghost cells; state names give the current state."""
        array = self.current(name) if name in STATE_NAMES else self.arrays[name]
        view: FloatRaster = array.numpy()[GHOSTS:-GHOSTS, GHOSTS:-GHOSTS]
        return view
