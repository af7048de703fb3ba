"""The parts that follow every flux step of a model, in their fixed order."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.breaches import Breaches
from solver_service.numerics.conduits import Conduits
from solver_service.numerics.device import load_structure_kernels
from solver_service.numerics.fields import FieldStore
from solver_service.numerics.forcing import Forcing
from solver_service.numerics.infiltration import GroundUptake
from solver_service.numerics.model import FloodModel
from solver_service.numerics.params import SolverParams
from solver_service.numerics.step_part import StepPart
from solver_service.numerics.structures import Weir


def parts_of(
    model: FloodModel, params: SolverParams, store: FieldStore, tiles: ActiveTiles
) -> tuple[StepPart, ...]:
    """The parts that the model asks for: structures, then sources and rain, then infiltration.

    Args:
        model: what does not move.
        params: scheme and tuning.
        store: rasters of the run.
        tiles: the tiles that are computed; with infiltration every wet one.
    """
    parts = _structures_of(model, params, store)
    if Forcing.is_needed(model):
        parts.append(Forcing(model, params.cfl, store.device))
    if model.infiltration is not None:
        parts.append(
            GroundUptake(model.infiltration, store, tiles, params.depth_film, params.depth_dry, model.dx)
        )
    return tuple(parts)


def _structures_of(model: FloodModel, params: SolverParams, store: FieldStore) -> list[StepPart]:
    """Culverts and pumps, then breaches, which lower the bed that those have seen."""
    parts: list[StepPart] = []
    if model.structures or model.breaches:
        load_structure_kernels(store.device)
    conduits = tuple(built for built in model.structures if not isinstance(built, Weir))
    if conduits:
        parts.append(Conduits(conduits, store, model.dx, params.cfl, params.depth_dry))
    if model.breaches:
        parts.append(Breaches(model.breaches, store, model.dx, params.depth_dry))
    return parts


def changeable_cells(parts: tuple[StepPart, ...], shape: tuple[int, int]) -> npt.NDArray[np.bool_]:
    """Cells that any part may change even where nothing moves, [nrows, ncols]."""
    mask = np.zeros(shape, np.bool_)
    for part in parts:
        mask |= part.cells()
    return mask
