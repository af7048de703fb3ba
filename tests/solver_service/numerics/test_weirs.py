"""Walls along faces: discharges against the formulas, rest, volume, maxima, sleep, engines."""

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, ShallowWaterSolver, SolverParams
from solver_service.numerics.snapping import EAST_FACE, NORTH_FACE
from solver_service.numerics.structures import Weir
from solver_service.numerics.weirs import highest_walls
from tests.solver_service.numerics.floods import bed, differences, full_model, wild_water

SHAPE = (40, 60)
DX = 5.0


def wall(crest, col=29.5, rows=(-0.5, 39.5), **changes):
    """A straight wall from south to north."""
    return Weir("wall", ((col, rows[0]), (col, rows[1])), crest, **changes)


def solver(*weirs, z=None, boundaries=(), manning_n=0.03, **params):
    z = np.zeros(SHAPE, np.float32) if z is None else z
    model = FloodModel(DX, z, manning_n, boundaries=boundaries, structures=weirs)
    return ShallowWaterSolver(model, SolverParams(**({"threads": 1} | params)), "cpu")


def halves(west, east, col=30, shape=SHAPE):
    """Depths west and east of a column."""
    return np.broadcast_to(np.where(np.arange(shape[1]) < col, west, east), shape).astype(np.float32)


def test_below_its_crest_a_wall_holds_deep_water_at_rest_for_ever():
    s = solver(wall(3.0), z=bed(SHAPE, roughness=0.2))
    level = np.where(np.arange(SHAPE[1]) < 30, 2.9, 1.1)
    s.set_water(np.maximum(level - s.bed, 0.0).astype(np.float32))
    before = s.depth()
    s.advance_to(60.0)
    assert np.array_equal(s.depth(), before)
    assert all(not component.any() for component in s.velocity())
    assert s.maxima().speed.max() == 0.0, "the water that the flux step sent through the wall is forgotten"


def test_waves_are_thrown_back_by_a_wall_as_by_the_rim_of_the_grid():
    count = 40
    waves = (5.0 + 0.5 * np.cos(np.arange(count) * np.pi / count) * np.ones((count, 1))).astype(np.float32)
    s = solver(
        wall(20.0, col=count - 0.5, rows=(-0.5, count - 0.5)), z=np.zeros((count, 2 * count), np.float32)
    )
    s.set_water(np.hstack([waves, np.zeros_like(waves)]))
    alone = solver(z=np.zeros((count, count), np.float32))
    alone.set_water(waves)
    for run in (s, alone):
        run.advance_to(35.0)
    assert np.abs(s.depth()[:, :count] - alone.depth()).max() < 3e-3
    assert np.abs(alone.depth() - waves).max() > 0.2
    assert not s.depth()[:, count:].any()
    assert s.step_count < 1.1 * alone.step_count, (
        "what the flux step sends through the wall hardly costs steps"
    )


def test_without_the_wall_the_same_water_falls():
    s = solver()
    s.set_water(halves(2.9, 0.0))
    s.advance_to(5.0)
    assert s.depth()[:, 31].min() > 0.5


def reached(weir, start, shape=SHAPE):
    """Cells that can be reached from a cell without crossing a wall."""
    closed = {tuple(face) for face in weir.snapped(shape, DX).faces.tolist()}
    seen, todo = np.zeros(shape, bool), [start]
    seen[start] = True
    while todo:
        row, col = todo.pop()
        for other, face in (
            ((row, col + 1), (row, col, EAST_FACE)),
            ((row, col - 1), (row, col - 1, EAST_FACE)),
            ((row + 1, col), (row, col, NORTH_FACE)),
            ((row - 1, col), (row - 1, col, NORTH_FACE)),
        ):
            inside = 0 <= other[0] < shape[0] and 0 <= other[1] < shape[1]
            if inside and not seen[other] and face not in closed:
                seen[other] = True
                todo.append(other)
    return seen


@pytest.mark.parametrize("line", [((-0.5, 4.2), (59.5, 33.7)), ((10.0, -0.5), (12.0, 20.0), (40.0, 39.5))])
def test_a_staircase_holds_too(line):
    s = solver(Weir("wall", line, 3.0))
    depth = np.where(reached(s.model.structures[0], (0, SHAPE[1] - 1)), 0.0, 2.5).astype(np.float32)
    assert 0.0 < depth.mean() < 2.5
    s.set_water(depth)
    s.advance_to(30.0)
    assert np.array_equal(s.depth(), depth)


def test_water_between_two_walls_one_cell_apart_rests():
    s = solver(wall(3.0, col=29.5), wall(3.0, col=30.5))
    depth = halves(2.5, 1.0)
    depth[:, 30] = 1.7
    s.set_water(depth)
    s.advance_to(30.0)
    assert np.array_equal(s.depth(), depth)


def test_a_lake_over_a_drowned_wall_rests():
    s = solver(wall(0.8), z=bed(SHAPE, roughness=0.2))
    before = np.maximum(3.3 - s.bed, 0.0).astype(np.float32)
    s.set_water(before)
    s.advance_to(60.0)
    assert np.array_equal(s.depth(), before)
    assert all(not component.any() for component in s.velocity())


def channel(weir, discharge, stage):
    """Heads above the crest on both sides of a wall across a channel in steady flow."""
    shape = (2, 40)
    crest = weir.crest
    boundaries = (
        EdgeBoundary("west", "discharge", 0, 2, times=[0.0], values=[discharge * 2 * DX]),
        EdgeBoundary("east", "stage", 0, 2, times=[0.0], values=[stage]),
    )
    s = solver(weir, z=np.zeros(shape, np.float32), boundaries=boundaries, manning_n=0.03)
    s.set_water(halves(max(crest + 0.5, stage), stage, col=20, shape=shape))
    s.advance_to(1200.0)
    eta = s.depth() + s.bed
    u = s.velocity()[0]
    steady = np.abs((s.depth() * u)[:, 5:35] - discharge).max()
    assert steady < 0.01 * discharge
    assert abs(s.budget().error_relative) < 1e-6
    return float(eta[:, 19].mean()) - crest, float(eta[:, 20].mean()) - crest


@pytest.mark.parametrize("coefficient", [1.7, 1.4])
def test_free_overflow_in_steady_flow_follows_poleni(coefficient):
    weir = Weir("wall", ((19.5, -0.5), (19.5, 1.5)), 2.0, coefficient)
    up, down = channel(weir, 1.0, 1.0)
    assert down < 0.0
    assert coefficient * up**1.5 == pytest.approx(1.0, rel=0.02)


@pytest.mark.parametrize("stage", [2.45, 2.6, 2.9])
def test_drowned_overflow_in_steady_flow_follows_villemonte(stage):
    weir = Weir("wall", ((19.5, -0.5), (19.5, 1.5)), 2.0)
    up, down = channel(weir, 1.0, stage)
    assert 0.5 < down / up < 0.9
    assert 1.7 * up**1.5 * (1.0 - (down / up) ** 1.5) ** 0.385 == pytest.approx(1.0, rel=0.02)
    free, _ = channel(weir, 1.0, 1.0)
    assert up > 1.02 * free, "the tailwater is felt"


def test_a_deeply_drowned_sill_hardly_hinders_the_flow():
    weir = Weir("sill", ((19.5, -0.5), (19.5, 1.5)), 0.2)
    up, down = channel(weir, 2.0, 3.0)
    assert 0.0 < up - down < 0.03
    buried = Weir("buried", ((19.5, -0.5), (19.5, 1.5)), -0.2)
    up, down = channel(buried, 2.0, 3.2)
    assert abs(up - down) < 2e-3


def test_levels_equalise_without_swinging():
    shape = (4, 12)
    s = solver(wall(1.0, col=5.5, rows=(-0.5, 3.5)), z=np.zeros(shape, np.float32))
    s.set_water(halves(1.5, 1.1, col=6, shape=shape))
    s.advance_to(600.0)
    eta = s.depth()
    assert abs(eta[:, 5].mean() - eta[:, 6].mean()) < 2e-3
    assert np.abs(s.velocity()[0]).max() < 0.02
    assert abs(s.budget().error_relative) < 1e-7


def test_a_diagonal_wall_spills_by_its_length_and_not_by_that_of_its_staircase():
    spilled = []
    for line in (((-0.5, 19.5), (39.5, 19.5)), ((9.5, -0.5), (39.5, 29.5))):
        weir = Weir("wall", line, 2.0)
        shape = (40, 40)
        s = solver(weir, z=np.zeros(shape, np.float32))
        dry = reached(weir, (0, 39), shape)
        s.set_water(np.where(dry, 0.0, 2.3).astype(np.float32))
        s.advance_to(10.0)
        length = np.hypot(line[1][0] - line[0][0], line[1][1] - line[0][1]) * DX
        spilled.append(s.depth()[dry].sum(dtype=float) * DX * DX / length)
    assert spilled[1] == pytest.approx(spilled[0], rel=0.05)
    assert len(weir.snapped(shape, DX).faces) * DX > 1.35 * length, "the staircase is that much longer"


def test_the_highest_of_several_walls_at_a_face_counts():
    walls = highest_walls((wall(1.0), wall(2.0, rows=(9.5, 19.5)), wall(1.5)), SHAPE)
    assert len(walls) == SHAPE[0]
    assert walls[(15, 29, 0)] == (2.0, 1.7)
    assert walls[(5, 29, 0)] == (1.5, 1.7)


def full_walls(z):
    """Walls of all kinds: dry, spilling, drowned, crossing, touching the rim, diagonal, a cell apart."""
    return (
        Weir("west", ((14.5, -0.5), (14.5, 69.5)), 3.0),
        Weir("next", ((15.5, 10.0), (15.5, 50.0)), 2.2),
        Weir("slope", ((20.0, 5.0), (80.0, 60.0)), (1.0, 4.0), 1.84),
        Weir("low", ((-0.5, 20.0), (89.5, 24.0)), 1.2),
    )


def wild(engine, threads=1, weirs=True, **scheme):
    base = full_model()
    model = FloodModel(
        base.dx, base.z_b, base.manning_n, boundaries=base.boundaries, sources=base.sources, rain=base.rain,
        blocked=base.blocked, structures=full_walls(base.z_b) if weirs else (),
    )  # fmt: skip
    params = SolverParams(engine=engine, threads=threads, arrival_depths=(0.1, 0.5), **scheme)
    s = ShallowWaterSolver(model, params, "cpu")
    s.set_water(*wild_water(model.z_b))
    return s


def test_every_engine_gives_the_same_bits_with_walls():
    runs = [wild("kernels"), wild("tiles"), wild("rows"), wild("rows", threads=3)]
    for s in runs:
        s.advance_to(1.1)
        s.advance_to(6.0)
    for other in runs[1:]:
        assert differences(runs[0], other) == []
    assert abs(runs[0].budget().error_relative) < 3e-7
    free = wild("rows", weirs=False)
    free.advance_to(6.0)
    assert "h" in differences(runs[0], free), "the walls do something"


def test_a_split_run_with_an_edit_equals_the_whole_bit_for_bit():
    whole, part = wild("rows"), wild("rows")
    whole.advance_to(2.0)
    part.restore(whole.snapshot())
    for s in (whole, part):
        s.advance_to(3.0)
        s.replace_bed(bed(seed=5))
        s.advance_to(5.0)
    assert differences(whole, part) == []


def test_sleeping_tiles_at_walls_change_no_bit(monkeypatch):
    shape = (64, 160)
    z = (0.05 * np.random.default_rng(3).random(shape)).astype(np.float32)
    depth = np.zeros(shape, np.float32)
    depth[:, :40] = 2.4
    weirs = (
        Weir("dam", ((39.5, -0.5), (39.5, 63.5)), 2.3),
        Weir("far", ((99.5, -0.5), (99.5, 63.5)), 0.4),
        Weir("never", ((140.0, -0.5), (150.0, 63.5)), 5.0),
    )

    def run(awake):
        s = solver(*weirs, z=z)
        if awake:
            s._tiles.keep_awake(np.ones(shape, bool))
        s.set_water(depth)
        s.advance_to(60.0)
        return s

    sleeping, awake = run(False), run(True)
    assert sleeping.active_cells < awake.active_cells
    assert differences(sleeping, awake) == []


def test_the_courant_condition_holds_beside_walls():
    s = wild("rows")
    for time in np.arange(0.1, 6.0, 0.1):
        s.advance_to(float(time))
        (u, v), c = s.velocity(), np.sqrt(9.81 * s.depth())
        wave = float((np.maximum(np.abs(u), np.abs(v)) + c).max())
        assert wave <= 1.15 * s._engine.wave_speed + 0.5
