"""Mirror and quarter-turn symmetry of edges, rain, sources, infiltration and roughness: no side is preferred.

A bumpy ground with another kind of edge on each side, rain and infiltration that differ from place to place
and a source is run as it is and mirrored, transposed or turned. What comes out must be the mirrored,
transposed or turned water.
"""

import numpy as np
import pytest

from solver_service.numerics import (
    EdgeBoundary,
    FloodModel,
    Infiltration,
    Rain,
    ShallowWaterSolver,
    SolverParams,
    Source,
)
from tests.validation.runs import square
from tests.validation.test_symmetry import TURNS

CASE = "Symmetry with edges, rain, source and infiltration, 64 x 64 cells"
GRID = square(64, 640.0)
N = GRID.nrows
SIDES = {
    "west": np.s_[1:-1, 0],
    "east": np.s_[1:-1, -1],
    "south": np.s_[0, 1:-1],
    "north": np.s_[-1, 1:-1],
}
KINDS = (
    ("west", 10, 40, {"kind": "discharge", "times": [0.0, 30.0], "values": [40.0, 120.0]}),
    ("east", 5, 60, {"kind": "stage", "times": [0.0, 40.0], "values": [1.2, 2.4]}),
    ("south", 20, 50, {"kind": "open"}),
    ("north", 0, 33, {"kind": "normal_depth", "slope": 0.01}),
)


def turned_edges(turn):
    """The boundaries where the turn puts them: each is painted on a frame that is turned with the grid."""
    edges = []
    for side, first, last, what in KINDS:
        frame = np.zeros((N + 2, N + 2), bool)
        frame[SIDES[side]][first:last] = True
        frame = turn(frame)
        (found,) = (name for name, where in SIDES.items() if frame[where].any())
        cells = np.flatnonzero(frame[SIDES[found]])
        edges.append(EdgeBoundary(found, first=int(cells[0]), last=int(cells[-1]) + 1, **what))
    return tuple(edges)


def run(turn, edges=turned_edges):
    x, y = GRID.centres
    bed = 0.5 + 0.4 * np.sin(x / 37.0 + 1.0) * np.cos(y / 23.0) + 0.1 * np.sin(y / 11.0)
    column = np.where(
        (np.abs(x - 40.0) < 150.0) & (np.abs(y + 30.0) < 100.0), np.maximum(3.0 - bed, 0.0), 0.0
    )
    spring = np.zeros(x.shape, bool)
    spring[50:53, 12:14] = True
    rates = 3e-5 * (1.0 + np.sin(x / 50.0) * np.cos(y / 90.0))
    zones = ((x + 0.5 * y) > 30.0).astype(np.int32)
    bed, column, spring, rates, zones, rough = (
        np.ascontiguousarray(turn(q)) for q in (bed, column, spring, rates, zones, 0.02 + 0.01 * (y > x))
    )
    rows, cols = np.nonzero(spring)
    model = FloodModel(
        dx=GRID.dx,
        z_b=bed,
        manning_n=rough,
        boundaries=edges(turn),
        sources=(Source(rows, cols, np.array([0.0, 20.0]), np.array([0.0, 30.0])),),
        rain=Rain(np.array([0.0]), rates[None], np.arange(N), np.arange(N)),
        infiltration=Infiltration("constant", zones, {"rate": np.array([0.0, 1e-5])}),
    )
    solver = ShallowWaterSolver(model, SolverParams(), device="cpu")
    solver.set_water(column.astype(np.float32))
    solver.advance_to(40.0)
    return solver.depth(), solver.budget()


@pytest.fixture(scope="module")
def unturned():
    return run(lambda q: q)


@pytest.mark.parametrize("name", TURNS)
def test_turned_ground_with_all_features_gives_turned_water(name, unturned, figure):
    depth, _ = run(TURNS[name])
    off = np.abs(depth - TURNS[name](unturned[0])).max()
    figure(CASE, f"largest difference of h, {name}", off, unit="m", below=0.0)


def test_every_feature_takes_part(unturned):
    budget = unturned[1]
    assert abs(budget.error_relative) < 1e-7
    assert budget.rain > 0.0
    assert budget.infiltration > 0.0
    assert all(volume > 1.0 for volume in budget.sources.values())
    flows = {name: sum(np.abs(both)) for name, both in budget.edges.items()}
    assert len(flows) == 4
    assert all(volume > 0.1 for volume in flows.values()), flows


def test_an_edge_left_behind_is_seen(unturned):
    """The negative control: the ground is mirrored, its edges are not."""
    depth, _ = run(TURNS["mirrored west to east"], edges=lambda turn: turned_edges(lambda q: q))
    assert np.abs(depth - unturned[0][:, ::-1]).max() > 0.1
