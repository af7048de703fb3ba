"""Every part of the step keeps to the protocol that engines, solver and snapshots rely on."""

import math

import numpy as np
import pytest

from solver_service.numerics import SolverParams
from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.after_step import parts_of
from solver_service.numerics.edges import Edges
from solver_service.numerics.fields import FieldStore, Scheme
from tests.solver_service.numerics.floods import full_model

MODEL = full_model()


@pytest.fixture
def parts():
    store = FieldStore(*MODEL.shape, "cpu")
    params = SolverParams()
    edges = Edges(MODEL, params, store)
    return parts_of(MODEL, params, store, ActiveTiles(store, 1e-5), Scheme(), edges)


def test_no_two_parts_use_the_same_array_name(parts):
    names = [name for part in parts for name in part.names]
    assert names
    assert len(set(names)) == len(names)


def test_a_part_gives_the_arrays_it_names_and_takes_them_back(parts):
    for part in parts:
        part.begin()
        arrays = part.snapshot()
        assert set(arrays) == set(part.names)
        other = {name: array + np.ones_like(array) for name, array in arrays.items()}
        part.restore(other)
        for name, array in part.snapshot().items():
            np.testing.assert_array_equal(array, other[name])


def test_a_part_says_which_cells_it_may_change_and_how_long_a_step_may_be(parts):
    for part in parts:
        assert part.cells().shape == MODEL.shape
        assert part.cells().dtype == np.bool_
        assert 0.0 < part.dt_max <= math.inf
