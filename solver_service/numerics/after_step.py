"""The parts that follow every flux step of a model, in their fixed order."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.breaches import Breaches
from solver_service.numerics.conduits import Conduits
from solver_service.numerics.device import load_structure_kernels
from solver_service.numerics.edges import Edges
from solver_service.numerics.fields import FieldStore, Scheme
from solver_service.numerics.forcing import Forcing
from solver_service.numerics.infiltration import GroundUptake
from solver_service.numerics.model import FloodModel
from solver_service.numerics.params import SolverParams
from solver_service.numerics.step_part import StepPart
from solver_service.numerics.structures import Weir
from solver_service.numerics.weirs import Weirs


def parts_of(
    model: FloodModel,
    params: SolverParams,
    store: FieldStore,
    tiles: ActiveTiles,
    scheme: Scheme,
    edges: Edges,
) -> tuple[StepPart, ...]:
    """The parts that the model asks for.

    Weirs come first, as they belong to the flux step, and edges next, as they correct it; then culverts and
    pumps, breaches, which lower the bed that all those have seen, sources and rain, infiltration.

    Args:
        model: what does not move.
        params: scheme and tuning.
        store: rasters of the run.
        tiles: the tiles that are computed; with infiltration every wet one.
        scheme: numbers of the scheme.
        edges: what happens at the edges.
    """
    parts: list[StepPart] = []
    if model.structures or model.breaches:
        load_structure_kernels(store.device)
    weirs = tuple(built for built in model.structures if isinstance(built, Weir))
    conduits = tuple(built for built in model.structures if not isinstance(built, Weir))
    if weirs:
        parts.append(Weirs(weirs, store, tiles, scheme))
    if edges.count:
        parts.append(edges)
    if conduits:
        parts.append(Conduits(conduits, store, model.dx, params.cfl, params.depth_dry))
    if model.breaches:
        parts.append(Breaches(model.breaches, store, model.dx, params.depth_dry))
    if Forcing.is_needed(model):
        parts.append(Forcing(model, params.cfl, store.device))
    if model.infiltration is not None:
        parts.append(
            GroundUptake(model.infiltration, store, tiles, params.depth_film, params.depth_dry, model.dx)
        )
    return tuple(parts)


def changeable_cells(parts: tuple[StepPart, ...], shape: tuple[int, int]) -> npt.NDArray[np.bool_]:
    """Cells that any part may change even where nothing moves, [nrows, ncols]."""
    mask = np.zeros(shape, np.bool_)
    for part in parts:
        mask |= part.cells()
    return mask
