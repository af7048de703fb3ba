"""Random floods with every feature at once, through every engine, in strips, cut in two, and on a GPU.

Compared is the whole snapshot (water, bed, maxima, edge volumes, ledgers of each part of the step, records of
gauges and sections, clock), so that no feature can drift apart between engines unseen.
"""

import numpy as np
import pytest

from solver_service.numerics import (
    Breach,
    Culvert,
    EdgeBoundary,
    FloodModel,
    Infiltration,
    Pump,
    Rain,
    Section,
    ShallowWaterSolver,
    SolverParams,
    Source,
    Weir,
    device_names,
)

ROWS, COLS, DX = 53, 75, 4.0
LEVEE = 30
TIMES = (2.1, 5.0, 9.0)
SEEDS = (1, 2, 3)
GPUS = [name for name in device_names() if name.startswith("cuda")]

INFILTRATION = (
    Infiltration("constant", None, {"rate": [2e-4], "capacity": [1e-3]}),
    Infiltration("horton", None, {"f0": [5e-4], "fc": [1e-5], "k": [0.3]}),
    Infiltration("green_ampt", None, {"conductivity": [1e-5], "suction": [0.2], "deficit": [0.3]}),
)


def ground(rng):
    """Rough hills with a levee from the southern to the northern edge at column `LEVEE`, flat at its foot."""
    y, x = np.mgrid[0:ROWS, 0:COLS]
    z = 0.4 * np.sin(x / 6.0 + rng.uniform(0.0, 6.0)) * np.cos(y / 8.0) + 0.5 * rng.random((ROWS, COLS))
    z[:, LEVEE] = 3.0
    return z.astype(np.float32)


def model_of(seed):
    """Every feature, placed and sized at random."""
    rng = np.random.default_rng(seed)
    z = ground(rng)
    blocked = rng.random(z.shape) < 0.01
    blocked[:, 4 : LEVEE + 30] = False
    law = INFILTRATION[seed % len(INFILTRATION)]
    zones = rng.integers(0, 2, z.shape, dtype=np.int32)
    doubled = {name: np.repeat(values, 2) * [1.0, 0.5] for name, values in law.parameters.items()}
    row = int(rng.integers(18, 34))
    return FloodModel(
        dx=DX,
        z_b=z,
        manning_n=(0.02 + 0.03 * rng.random(z.shape)).astype(np.float32),
        boundaries=(
            EdgeBoundary("west", "discharge", 8, 25, "river", [0.0, 5.0, 20.0], [5.0, 60.0, 30.0]),
            EdgeBoundary("west", "discharge", 30, 36, "outlet", [0.0], [-8.0]),
            EdgeBoundary("east", "stage", 5, 45, "tide", [0.0, 4.0, 9.0], [0.8, 2.0, 1.0]),
            EdgeBoundary("south", "normal_depth", 3, 25, "plain", slope=0.01),
            EdgeBoundary("north", "open", 10, 28, "gap"),
        ),
        sources=(Source([40, 40, 41], [50, 51, 50], [0.0, 4.0, 12.0], [0.0, 60.0, 20.0], "spring"),),
        rain=Rain(
            [0.0, 3.0, 7.0],
            rng.uniform(0.0, 2e-4, (3, 2, 3)),
            np.arange(ROWS) * 2 // ROWS,
            np.arange(COLS) * 3 // COLS,
            "step" if seed % 2 else "linear",
        ),
        infiltration=Infiltration(law.kind, zones, doubled),
        structures=(
            Weir("wall", ((50.5, 4.0), (50.5, 20.0), (58.0, 26.5)), (1.2, 1.6, 1.4)),
            Culvert("pipe", ((row - 8, LEVEE - 2),), ((row - 8, LEVEE + 2),), 0.4, 0.2, 1.5, 1.0, 16.0),
            Pump("lift", ((row, LEVEE + 3),), ((row, LEVEE - 4),), (0.0, 2.0), (0.5, 2.0)),
            Pump("drain", ((12, 60),), None, (0.0, 1.0), (0.2, 1.0), "level", 0.8, 0.5),
        ),
        breaches=(
            Breach("gate", ((LEVEE, 36.0), (LEVEE, 50.0)), 3.0, 0.5, 4.0, 8.0, 30.0, start_time=1.5),
            Breach(
                "dyke", ((LEVEE, 3.0), (LEVEE, 16.0)), 3.0, 0.5, 3.0, 6.0,
                start="overtopping", law="verheij_van_der_knaap",
            ),
        ),
        blocked=blocked,
    )  # fmt: skip


def water_of(z, seed):
    """A lake that spills over the levee, pools and dry ground behind it, all in random motion."""
    rng = np.random.default_rng(seed + 100)
    level = np.where(np.arange(COLS) <= LEVEE, 3.3, 0.9)
    h = np.maximum(level - z, 0.0) * (rng.random(z.shape) < 0.95)
    h[:, 66:] = 0.0
    u, v = rng.normal(0.0, 0.5, (2, *z.shape)) * (h > 0.0)
    return h.astype(np.float32), u.astype(np.float32), v.astype(np.float32)


def begun(seed, device="cpu", **params):
    """A solver at time zero."""
    model = model_of(seed)
    options = {
        "gauges": ((10.0, 12.0), (50.4, 33.3)),
        "gauge_interval": 0.35,
        "sections": (
            Section("levee", ((LEVEE + 2.5, 1.0), (LEVEE + 2.5, 51.0))),
            Section("bend", ((5, 5), (20, 30))),
        ),
        "arrival_depths": (0.1, 0.5),
    } | params
    solver = ShallowWaterSolver(model, SolverParams(**options), device)
    solver.set_water(*water_of(model.z_b, seed))
    return solver


def run(seed, device="cpu", **params):
    solver = begun(seed, device, **params)
    for time in TIMES:
        solver.advance_to(time)
    return solver


def differences(a, b):
    """Names of what differs between two solvers in any bit."""
    left, right = a.snapshot(), b.snapshot()
    assert left.arrays.keys() == right.arrays.keys()
    found = [
        name
        for name in left.arrays
        if not np.array_equal(left.arrays[name], right.arrays[name], equal_nan=True)
    ]
    # The last time step is for reading; only the rows engine keeps it.
    numbers = left.scalars.keys() - {"dt"}
    found += [name for name in numbers if left.scalars[name] != right.scalars[name]]
    if a.budget().as_dict() != b.budget().as_dict():
        found.append("budget")
    return found


@pytest.fixture(scope="module", params=SEEDS)
def oracle(request):
    """Seed and the flood that single cells, one after the other, compute."""
    return request.param, run(request.param, engine="kernels")


def test_every_feature_moves_water(oracle):
    _, solver = oracle
    budget = solver.budget()
    assert budget.rain > 0.0
    assert budget.infiltration > 0.0
    assert budget.sources["spring"] > 0.0
    assert budget.edges["river"][0] > 0.0
    for name in ("outlet", "plain", "gap"):
        assert budget.edges[name][1] > 0.0, name
    assert max(budget.edges["tide"]) > 0.0
    assert budget.structures["drain"] > 0.0
    assert budget.moved["pipe"] != 0.0
    assert budget.moved["lift"] > 0.0
    assert [state.started_at is not None for state in solver.breach_states()] == [True, True]
    assert all(state.width > 0.0 for state in solver.breach_states())
    assert solver.step_count > 40
    assert abs(budget.error_relative) < 1e-6


@pytest.mark.parametrize(
    "params",
    [
        {"engine": "tiles"},
        {"engine": "rows", "threads": 1},
        {"engine": "rows", "threads": 3},
        {"engine": "rows", "threads": 7},
    ],
    ids=["tiles", "rows", "three-threads", "seven-threads"],
)
def test_engines_and_strips_give_the_same_bits(oracle, params):
    seed, expected = oracle
    assert differences(expected, run(seed, **params)) == []


@pytest.mark.parametrize(("first", "second"), [("rows", "rows"), ("rows", "kernels"), ("tiles", "rows")])
def test_run_cut_in_two_and_restored_gives_the_same_bits(oracle, first, second):
    seed, expected = oracle
    before = begun(seed, engine=first)
    for time in TIMES[:2]:
        before.advance_to(time)
    after = begun(seed, engine=second)
    after.restore(before.snapshot())
    after.advance_to(TIMES[2])
    assert differences(expected, after) == []


def test_comparison_sees_one_changed_bit():
    a, b = begun(1), begun(1)
    assert differences(a, b) == []
    h, u, v = water_of(a.model.z_b, 1)
    h[20, 10] = np.nextafter(h[20, 10], np.float32(9.0))
    b.set_water(h, u, v)
    assert "h" in differences(a, b)


@pytest.mark.gpu
@pytest.mark.skipif(not GPUS, reason="no CUDA device")
def test_cuda_gives_the_same_flood_within_rounding(oracle):
    """Roots and divisions are exact on both and products are not fused, but libm functions may differ."""
    seed, expected = oracle
    solver = run(seed, GPUS[0])
    off = np.abs(solver.depth() - expected.depth())
    assert off.mean() < 1e-6
    assert off.max() < 1e-3
    assert abs(solver.step_count - expected.step_count) <= 1
    for name in ("h", "speed", "hazard"):
        mine, theirs = getattr(solver.maxima(), name), getattr(expected.maxima(), name)
        assert np.abs(mine - theirs).mean() < 1e-5, name
    assert differences(solver, run(seed, GPUS[0])) == [], "the same run twice on the GPU"
