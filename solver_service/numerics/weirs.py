"""The weirs of a model on its device: the faces they took, and the cells beside these; see `weir_kernels`."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import warp as wp

from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.fields import GHOSTS, TILE, Fields, FieldStore, Scheme
from solver_service.numerics.snapping import EAST_FACE
from solver_service.numerics.step_part import PartVolumes
from solver_service.numerics.structures import Weir
from solver_service.numerics.weir_kernels import (
    CELL_LENGTH,
    EAST,
    KEPT_LENGTH,
    LEFT_IS_BETWEEN,
    NORTH,
    RIGHT_IS_BETWEEN,
    SOUTH,
    WEST,
    remember_maxima,
    step_beside_weirs,
)

Face = tuple[int, int, int]


def highest_walls(weirs: tuple[Weir, ...], shape: tuple[int, int]) -> dict[Face, tuple[float, float]]:
    """Crest [m] and coefficient [m^0.5/s] of every face that a weir takes; of several the highest."""
    walls: dict[Face, tuple[float, float]] = {}
    for weir in weirs:
        faces = weir.snapped(shape, 1.0).faces
        levels, shares = weir.face_levels(faces)
        for face, level, share in zip(faces.tolist(), levels.tolist(), shares.tolist(), strict=True):
            wall = (level, weir.coefficient * share)
            walls[tuple(face)] = max(wall, walls.get(tuple(face), wall))
    return walls


class Weirs:
    """Steps the cells beside weirs; a `StepPart` that comes before all others.

    Args:
        weirs: at least one.
        store: rasters of the run.
        tiles: the tiles that are computed.
        scheme: numbers of the scheme.
    """

    names: tuple[str, ...] = ()
    dt_max = math.inf

    def __init__(
        self, weirs: tuple[Weir, ...], store: FieldStore, tiles: ActiveTiles, scheme: Scheme
    ) -> None:
        self._store, self._tiles, self._scheme = store, tiles, scheme
        walls = highest_walls(weirs, (store.nrows, store.ncols))
        sides = self._sides(list(walls))
        between = np.zeros(len(walls), np.int32)
        for row in sides.values():
            for left, right in ((WEST, EAST), (SOUTH, NORTH)):
                if row[left] >= 0 and row[right] >= 0:
                    between[row[right]] |= int(LEFT_IS_BETWEEN)
                    between[row[left]] |= int(RIGHT_IS_BETWEEN)
        self._cells = self._to_device(np.array(list(sides.values()), np.int32), wp.int32)
        self._crests = self._to_device(np.array([crest for crest, _ in walls.values()]), wp.float32)
        self._coefficients = self._to_device(np.array([c for _, c in walls.values()]), wp.float32)
        self._between = self._to_device(between, wp.int32)
        self.numbers: dict[Face, int] = {face: number for number, face in enumerate(walls)}
        kept = (len(sides), int(KEPT_LENGTH) + len(store.arrival_depths))
        self._kept = wp.zeros(kept, dtype=wp.float32, device=store.device)

    def _to_device(self, values: npt.NDArray, dtype: type) -> wp.array:
        return wp.array(values, dtype=dtype, device=self._store.device)

    def _sides(self, faces: list[Face]) -> dict[tuple[int, int], list[int]]:
        """Rows of `cells` of the kernel, by row and column of the cell."""
        sides: dict[tuple[int, int], list[int]] = {}

        def take(row: int, col: int, side: int, number: int) -> None:
            tile = (row // TILE) * self._tiles.cols + col // TILE
            entry = [row + GHOSTS, col + GHOSTS, tile, *[-1] * (CELL_LENGTH - 3)]
            sides.setdefault((row, col), entry)[side] = number

        for number, (row, col, face) in enumerate(faces):
            if face == EAST_FACE:
                take(row, col, int(EAST), number)
                take(row, col + 1, int(WEST), number)
            else:
                take(row, col, int(NORTH), number)
                take(row + 1, col, int(SOUTH), number)
        return dict(sorted(sides.items()))

    def wall_arrays(self) -> list[wp.array]:
        """Crests, coefficients and what lies between, by the number of the wall; see `weir_kernels`."""
        return [self._crests, self._coefficients, self._between]

    def cells(self) -> npt.NDArray[np.bool_]:
        """None: at a wall nothing happens while the water on both sides rests."""
        return np.zeros((self._store.nrows, self._store.ncols), np.bool_)

    def remember(self) -> None:
        """Take the maxima as they are now for those that the next step widens."""
        wp.launch(
            remember_maxima,
            dim=self._cells.shape[0],
            inputs=[self._store.fields[0], self._cells],
            outputs=[self._kept],
            device=self._store.device,
        )

    def begin(self) -> None:
        """See `StepPart.begin`."""
        self.remember()

    def apply(self, clock: wp.array, fields: Fields) -> None:
        """See `StepPart.apply`."""
        wp.launch(
            step_beside_weirs,
            dim=self._cells.shape[0],
            inputs=[
                fields,
                self._scheme,
                clock,
                self._tiles.active,
                self._cells,
                self._crests,
                self._coefficients,
                self._between,
            ],
            outputs=[self._kept],
            device=self._store.device,
        )

    def volumes(self) -> PartVolumes:
        """Nothing: water passes from cell to cell."""
        return PartVolumes()

    def snapshot(self) -> dict[str, npt.NDArray]:
        """Nothing: what is remembered stands in the rasters."""
        return {}

    def restore(self, arrays: Mapping[str, npt.NDArray]) -> None:
        """See `StepPart.restore`; the rasters are back already."""
        self.remember()
