"""Which parts follow the flux step of a model, and where they may change the water."""

import numpy as np

from solver_service.numerics import FloodModel, SolverParams, Source
from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.after_step import changeable_cells, parts_of
from solver_service.numerics.fields import FieldStore
from solver_service.numerics.forcing import Forcing
from tests.solver_service.numerics.floods import full_model

BED = np.zeros((6, 8), np.float32)


def parts(model):
    store = FieldStore(*model.shape, "cpu")
    return parts_of(model, SolverParams(), store, ActiveTiles(store, 1e-5))


def test_a_bare_model_has_no_parts():
    assert parts(FloodModel(5.0, BED, 0.03)) == ()
    assert not changeable_cells((), BED.shape).any()


def test_a_source_makes_one_part_that_may_change_its_cells():
    model = FloodModel(5.0, BED, 0.03, sources=(Source([2], [3], [0.0], [1.0]),))
    (forcing,) = parts(model)
    assert isinstance(forcing, Forcing)
    assert np.argwhere(changeable_cells((forcing,), BED.shape)).tolist() == [[2, 3]]


def test_rain_may_change_every_cell():
    model = full_model()
    assert changeable_cells(parts(model), model.shape).all()
