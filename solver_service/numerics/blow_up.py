"""What to say when a run has blown up: where, what stands there, and what likely brought it about."""

from __future__ import annotations

import numpy as np

from solver_service.errors import SolverBlowUp
from solver_service.numerics.fastest_cell import fastest_cell
from solver_service.numerics.fields import FieldStore
from solver_service.numerics.model import FloodModel

NEAR = 8
"""How far around the cell a cause is looked for [cells]."""

STEEP = 1.0
"""Bed slope to the next cell from which on it is named as the cause [1]."""


def explain_blow_up(
    model: FloodModel, store: FieldStore, time: float, dt_min: float, courant: float
) -> SolverBlowUp:
    """The error that tells time, cell, value and likely cause.

    Args:
        model: what does not move.
        store: rasters of the run, as the failed step left them.
        time: time reached [s].
        dt_min: smallest step allowed [s].
        courant: cfl dx [m].
    """
    for name, unit in (("h", "m"), ("u", "m/s"), ("v", "m/s")):
        values = store.interior(name)
        bad = ~np.isfinite(values)
        if name == "h":
            bad |= values < 0.0
        if bad.any():
            row, col = divmod(int(bad.argmax()), store.ncols)
            what = f"{name} is {values[row, col]} {unit}"
            return SolverBlowUp(time, row, col, what, likely_cause(model, store, row, col))
    fastest = fastest_cell(store)
    if fastest.wave * dt_min < courant and model.sources:  # not the water, but what a source will bring
        worst = max(model.sources, key=lambda source: source.discharge.max() / np.sqrt(source.rows.size))
        row, col = int(worst.rows[0]), int(worst.cols[0])
        what = f"the inflow asks for dt < {dt_min:g} s"
        return SolverBlowUp(time, row, col, what, likely_cause(model, store, row, col))
    what = f"the wave speed {fastest.wave:g} m/s asks for dt < {dt_min:g} s"
    cause = likely_cause(model, store, fastest.row, fastest.col)
    return SolverBlowUp(time, fastest.row, fastest.col, what, cause)


def likely_cause(model: FloodModel, store: FieldStore, row: int, col: int) -> str:
    """The likely cause of trouble in a cell, as a clause."""
    for number, source in enumerate(model.sources, 1):
        if (np.maximum(abs(source.rows - row), abs(source.cols - col)) <= NEAR).any():
            most, name = float(source.discharge.max()), source.id or f"source-{number}"
            return f"likely {name} near it, which brings up to {most:g} m3/s into {source.rows.size} cells"
    rows, cols = slice(max(row - NEAR, 0), row + NEAR + 1), slice(max(col - NEAR, 0), col + NEAR + 1)
    z = store.interior("z")[rows, cols].copy()
    if model.blocked is not None:
        z[model.blocked[rows, cols]] = np.nan
    steps = [np.abs(np.diff(z, axis=axis)).ravel() for axis in (0, 1)]
    steepest = float(np.nanmax(np.concatenate([*steps, [0.0]])))
    if steepest > STEEP * model.dx:
        return f"likely a bed step of {steepest:.1f} m between neighbouring cells near it"
    return "likely a bed, roughness or inflow value far out of range near it"
