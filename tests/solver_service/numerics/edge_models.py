"""Small models whose edges do something, for tests."""

import numpy as np

from solver_service.numerics import EdgeBoundary, FloodModel
from tests.solver_service.numerics.floods import solver


def edge(side, kind, first, last, **kw):
    return EdgeBoundary(side, kind, first, last, **kw)


def channel(length, dx, boundaries, z=0.0, manning_n=0.0, rows=2, **params):
    z = np.broadcast_to(np.asarray(z, np.float32), (rows, round(length / dx)))
    return solver(FloodModel(dx, z, manning_n, boundaries=boundaries), threads=1, **params)


def everywhere(kind, nrows, ncols, **kw):
    sides = (("west", nrows), ("east", nrows), ("south", ncols), ("north", ncols))
    return tuple(edge(side, kind, 0, count, **kw) for side, count in sides)
