"""How much memory a run takes, known before anything is allocated.

The table lists what a solver holds for as long as it lives: on the device (of a CPU run, that is the host
too) and, beside it, the host's own copy of the model. The tests compare it with what a solver has really
allocated. Not listed: what does not grow with the grid (series, gauges, structures: kilobytes), the compiled
kernels, and the passing copies of a snapshot or an output frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver_service.numerics.fields import GHOSTS, MAXIMA_NAMES, STATE_NAMES, TILE
from solver_service.numerics.model import FloodModel
from solver_service.numerics.params import SolverParams
from solver_service.numerics.row_engine import SCRATCH_PITCH
from solver_service.numerics.row_kernels import SCRATCH_ROWS

FLOAT = 4

EDGE_FACE_BYTES = 40
"""Per face of four edges as long as the longest: flows, volumes, weights and water at rest."""

TILE_BYTES = 20
"""Per compute tile: forced, lively quadrants, wave speed, active, list."""

CHUNK_BYTES = 20
"""Per compute tile on a CPU: rectangles for the row loops, their wave speeds."""


@dataclass(frozen=True)
class Allocation:
    """One line of the table."""

    name: str
    """What it is for."""
    nbytes: int
    """Memory [bytes]."""
    bytes_per_cell: float
    """The same in units of the cells of the grid."""
    is_on_device: bool
    """Whether it counts against the memory of the device."""


@dataclass(frozen=True)
class MemoryOptions:
    """What of a run decides how much memory it takes, besides its grid."""

    roughness_raster: bool = False
    """Whether Manning's n differs from cell to cell."""
    blocked_cells: bool = False
    """Whether the model has cells without data."""
    rain: bool = False
    """Whether it rains."""
    infiltration: bool = False
    """Whether the ground takes water."""
    infiltration_zones: bool = False
    """Whether it does so differently from zone to zone."""
    arrival_depths: int = 0
    """Depth classes whose arrival times are kept."""
    threads: int = 1
    """CPU threads."""

    @classmethod
    def of(cls, model: FloodModel, params: SolverParams, threads: int = 1) -> MemoryOptions:
        """Those of a model.

        Args:
            model: what does not move.
            params: scheme and tuning.
            threads: CPU threads.
        """
        ground = model.infiltration
        return cls(
            roughness_raster=np.ndim(model.manning_n) > 0,
            blocked_cells=model.blocked is not None,
            rain=model.rain is not None,
            infiltration=ground is not None,
            infiltration_zones=ground is not None and ground.zone is not None,
            arrival_depths=len(params.arrival_depths),
            threads=threads,
        )


def allocation_table(
    shape: tuple[int, int], options: MemoryOptions | None = None, device: str = "cpu"
) -> tuple[Allocation, ...]:
    """Memory of a run, largest first on the device, then on the host.

    Args:
        shape: (nrows, ncols) of the grid.
        options: what else decides.
        device: `cpu` or `cuda:N`.
    """
    options = options or MemoryOptions()
    nrows, ncols = shape
    cells = nrows * ncols
    padded = (nrows + 2 * GHOSTS) * (ncols + 2 * GHOSTS)
    tiles = -(-nrows // TILE) * -(-ncols // TILE)
    is_cpu = device == "cpu"
    work = TILE_BYTES * tiles + 4 * (padded - cells)
    if is_cpu:
        work += CHUNK_BYTES * tiles + FLOAT * options.threads * SCRATCH_ROWS * SCRATCH_PITCH
    on_device = {
        "water, two states": 2 * len(STATE_NAMES) * FLOAT * padded,
        "bed and roughness": 2 * FLOAT * padded,
        "maxima": len(MAXIMA_NAMES) * FLOAT * padded,
        "arrival by depth class": options.arrival_depths * FLOAT * padded,
        "infiltration": (2 * FLOAT + 2 * options.infiltration_zones) * cells * options.infiltration,
        "rain": (cells + 4 * (nrows + ncols)) * options.rain,
        "edges": EDGE_FACE_BYTES * 4 * max(shape),
        "tiles and work lists": work,
    }
    on_host = {
        "bed of the model and as edited": 2 * FLOAT * cells,
        "roughness of the model": FLOAT * cells * options.roughness_raster,
        "cells without data": cells * options.blocked_cells,
        "infiltration zones of the model": 4 * cells * options.infiltration_zones,
    }
    lines = [
        Allocation(name, int(nbytes), nbytes / cells, is_on_device)
        for table, is_on_device in ((on_device, True), (on_host, False))
        for name, nbytes in sorted(table.items(), key=lambda item: -item[1])
        if nbytes
    ]
    return tuple(lines)


def device_bytes(table: tuple[Allocation, ...], device: str = "cpu") -> int:
    """Memory that the device must have free [bytes]; of a CPU run, the host's copies count too."""
    return sum(line.nbytes for line in table if line.is_on_device or device == "cpu")
