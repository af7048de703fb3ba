"""Mirror and quarter-turn symmetry: no axis and no direction is preferred by the scheme.

A square column of water collapses over a bumpy, partly dry bed. The same run on the mirrored, transposed or
turned ground must give the mirrored, transposed or turned water, bit for bit.
"""

import numpy as np
import pytest

from tests.validation.runs import make_solver, square

CASE = "Symmetry: column on a bumpy dry bed, 64 x 64 cells"
GRID = square(64, 640.0)

TURNS = {
    "mirrored west to east": lambda q: q[:, ::-1],
    "mirrored south to north": lambda q: q[::-1],
    "transposed": lambda q: q.T,
    "turned by 90 degrees": np.rot90,
    "turned by 180 degrees": lambda q: q[::-1, ::-1],
}


def collapse(turn):
    x, y = GRID.centres
    bed = 0.5 + 0.4 * np.sin(x / 37.0 + 1.0) * np.cos(y / 23.0) + 0.1 * np.sin(y / 11.0)
    column = np.where(
        (np.abs(x - 40.0) < 150.0) & (np.abs(y + 30.0) < 100.0), np.maximum(5.0 - bed, 0.0), 0.0
    )
    solver = make_solver(np.ascontiguousarray(turn(bed)), GRID.dx, manning_n=0.03)
    solver.set_water(np.ascontiguousarray(turn(column)).astype(np.float32))
    solver.advance_to(30.0)
    return solver.depth(), np.hypot(*solver.velocity())


@pytest.fixture(scope="module")
def unturned():
    return collapse(lambda q: q)


@pytest.mark.parametrize("name", TURNS)
def test_turned_ground_gives_turned_water(name, unturned, figure):
    depth, _ = collapse(TURNS[name])
    off = np.abs(depth - TURNS[name](unturned[0])).max()
    figure(CASE, f"largest difference of h, {name}", off, unit="m", below=0.0)


def test_column_really_moves_and_is_not_symmetric_itself(unturned):
    depth, speed = unturned
    assert speed.max() > 1.0
    assert np.abs(depth - depth[:, ::-1]).max() > 0.5
