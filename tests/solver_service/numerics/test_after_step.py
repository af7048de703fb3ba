"""Which parts follow the flux step of a model, and where they may change the water."""

import numpy as np

from solver_service.numerics import EdgeBoundary, FloodModel, Infiltration, SolverParams, Source
from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.after_step import changeable_cells, parts_of
from solver_service.numerics.breach import Breach
from solver_service.numerics.breaches import Breaches
from solver_service.numerics.conduits import Conduits
from solver_service.numerics.edges import Edges
from solver_service.numerics.fields import FieldStore, Scheme
from solver_service.numerics.forcing import Forcing
from solver_service.numerics.infiltration import GroundUptake
from solver_service.numerics.structures import Pump, Weir
from solver_service.numerics.weirs import Weirs
from tests.solver_service.numerics.floods import full_model

BED = np.zeros((6, 8), np.float32)


def parts(model):
    store, params = FieldStore(*model.shape, "cpu"), SolverParams()
    return parts_of(model, params, store, ActiveTiles(store, 1e-5), Scheme(), Edges(model, params, store))


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


def test_parts_follow_in_the_order_in_which_they_build_on_each_other():
    model = FloodModel(
        5.0,
        np.zeros((30, 30), np.float32),
        0.03,
        boundaries=(EdgeBoundary("west", "open", 0, 5),),
        sources=(Source([2], [3], [0.0], [1.0]),),
        infiltration=Infiltration("constant", None, {"rate": [1e-6]}),
        structures=(
            Pump("pump", ((20, 4),), None, (0.0,), (1.0,)),
            Weir("wall", ((4.5, 4.5), (9.5, 4.5)), 1.0),
        ),
        breaches=(Breach("gap", ((8.0, 15.0), (20.0, 15.0)), 1.0, 0.0, 60.0, 5.0, 20.0),),
    )
    kinds = [Weirs, Edges, Conduits, Breaches, Forcing, GroundUptake]
    made = parts(model)
    assert [type(part) for part in made] == kinds
    names = [name for part in made for name in part.names]
    assert len(set(names)) == len(names)
    assert sorted(names) == sorted(name for part in made for name in part.snapshot())
    changeable = changeable_cells(made, model.shape)
    assert changeable[15, 14]
    assert changeable[20, 4]
    assert not changeable[4, 6], "walls let their tiles sleep"
