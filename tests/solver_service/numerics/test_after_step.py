"""Which parts follow the flux step of a model, and where they may change the water."""

import dataclasses

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
from solver_service.numerics.structures import Culvert, Pump, Weir
from solver_service.numerics.weirs import Weirs
from tests.solver_service.numerics.floods import GAUGES, differences, full_model, solver, wild_water

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


def everything_built():
    """The full model with weirs, a culvert, pumps, a breach that grows and infiltration besides."""
    bare = full_model()
    bare.blocked[25:45, 30:60] = False
    bare.blocked[[5, 12, 40, 60], [8, 9, 70, 75]] = False
    structures = (
        Weir("wall", ((14.5, -0.5), (14.5, 69.5)), 2.6),
        Weir("slope", ((20.0, 5.0), (80.0, 60.0)), (1.0, 4.0), 1.84),
        Culvert("culvert", ((5, 8),), ((40, 70),), 0.3, 0.1, 2.0, 1.0, 30.0),
        Pump("lift", ((12, 9),), ((60, 75),), (0.0, 4.0), (1.0, 3.0), "level", 0.5, 0.4),
        Pump("out", ((40, 70),), None, (0.0, 4.0), (0.5, 0.5)),
    )
    grown = Breach(
        "gap", ((45.0, 28.0), (45.0, 42.0)), 4.0, -0.5, 4.0, 10.0, 40.0, across=15.0, start_time=0.7
    )
    ground = Infiltration("green_ampt", None, {"conductivity": [1e-5], "suction": [0.1], "deficit": [0.3]})
    return dataclasses.replace(bare, structures=structures, breaches=(grown,), infiltration=ground)


def test_with_everything_on_all_engines_and_a_split_run_give_the_same_bits():
    model = everything_built()
    water = wild_water(model.z_b)
    ways = [{"engine": "kernels"}, {"engine": "tiles"}, {"engine": "rows"}, {"engine": "rows", "threads": 3}]
    runs = [solver(model, gauges=GAUGES, arrival_depths=(0.1, 0.5), **({"threads": 1} | way)) for way in ways]
    later = solver(model, gauges=GAUGES, arrival_depths=(0.1, 0.5), engine="rows", threads=2)
    for s in runs:
        s.set_water(*water)
        s.advance_to(1.5)
        s.advance_to(3.0)
    later.restore(runs[0].snapshot())
    for s in (*runs, later):
        s.advance_to(6.0)
    for other in (*runs[1:], later):
        assert differences(runs[0], other) == []
        assert other.breach_states() == runs[0].breach_states()
        assert other.conduit_states() == runs[0].conduit_states()
    assert abs(later.budget().error_relative) < 5e-7
    assert later.breach_states()[0].width == 40.0
    assert all(state.moved > 0.0 for state in later.conduit_states())
