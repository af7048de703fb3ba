"""Measures of basins with a moving shore: how far the shore is off and how much energy is left."""

import numpy as np
from numpy.typing import NDArray

from tests.validation.runs import State

Array = NDArray[np.float64]


def shore_mismatch(h: Array, exact: Array, depth: float, dx: float, perimeter: float) -> float:
    """Mean distance [cells] of the lines h = ``depth`` [m]: the area where one alone is wet, by length."""
    return float(((h > depth) != (exact > depth)).sum() * dx / perimeter)


def energy(state: State, bed: Array, gravity: float = 9.81) -> float:
    """Energy of the water per unit of density and cell area: kinetic plus potential [m3/s2]."""
    h, u, v = state
    return float((0.5 * h * (u * u + v * v) + 0.5 * gravity * h * (h + 2.0 * bed)).sum())
