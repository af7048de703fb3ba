"""The pictures that a run's terrain has, kept beside its bed so that viewers get them without the case."""

from __future__ import annotations

from protocol import Layer
from solver_service.scenario import Case
from solver_service.store import DataFolder, save_layer
from solver_service.terrain.imagery import imagery_picture, walls_picture

__all__ = ["keep_layers", "layers_of"]


def layers_of(case: Case) -> tuple[Layer, ...]:
    """Which pictures there are of the terrain of a case."""
    imagery: tuple[Layer, ...] = ("imagery",) if case.imagery is not None else ()
    walls: tuple[Layer, ...] = ("walls",) if case.model.blocked is not None else ()
    return imagery + walls


def keep_layers(folder: DataFolder, fingerprint: str, case: Case) -> None:
    """Write the pictures of a case.

    Args:
        folder: the data folder.
        fingerprint: name of the bed they belong to.
        case: the case.

    Raises:
        TerrainError: its imagery cannot be used.
        StoreError: they cannot be written.
    """
    if case.imagery is not None:
        save_layer(folder, fingerprint, "imagery", imagery_picture(case.imagery, case.grid))
    if case.model.blocked is not None:
        save_layer(folder, fingerprint, "walls", walls_picture(case.model.blocked))
