"""Uniform flow in a wide sloping channel against Manning's formula, driven by a source or through the edges.

Source: Chow (1959), "Open-Channel Hydraulics", chapter 6. Discharge q per width runs with the normal depth
h = (n q / sqrt(S))^(3/5): friction, slope, source and edges must agree on it, without a word to the solver
about depth.
"""

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, ShallowWaterSolver, SolverParams, Source

CASE = "Uniform flow against Manning, cells of 20 m"
DX, ROWS, COLS = 20.0, 4, 200
DISCHARGE = 2.0  # m2/s
MANNING_N = 0.03


def normal_depth(slope, manning_n=MANNING_N):
    return (manning_n * DISCHARGE / np.sqrt(slope)) ** 0.6


def steady(slope, until):
    """Depth, discharge per width and outflow per inflow of a channel that begins dry."""
    bed = np.broadcast_to(slope * DX * np.arange(COLS)[::-1], (ROWS, COLS)).astype(np.float32)
    rows = np.arange(ROWS, dtype=np.int32)
    feed = Source(
        rows=rows,
        cols=np.zeros(ROWS, np.int32),
        times=np.array([0.0, 60.0]),
        discharge=np.array([0.0, DISCHARGE * DX * ROWS]),
    )
    edge = EdgeBoundary(edge="east", kind="open", first=0, last=ROWS)
    model = FloodModel(dx=DX, z_b=bed, manning_n=MANNING_N, boundaries=(edge,), sources=(feed,))
    solver = ShallowWaterSolver(model, SolverParams(), device="cpu")
    solver.set_water(np.zeros((ROWS, COLS), np.float32))
    solver.advance_to(until - 600.0)
    before = solver.budget()
    solver.advance_to(until)
    after = solver.budget()
    passed = (after.outflow - before.outflow) / (after.inflow - before.inflow)
    assert abs(after.error_relative) < 2e-8
    depth = solver.depth().astype(np.float64)
    return depth, depth * solver.velocity()[0], passed


@pytest.mark.parametrize(
    ("slope", "until", "slack"),
    [(0.02, 3000.0, 1e-4), (0.002, 9000.0, 0.02)],
    ids=["supercritical", "subcritical"],
)
def test_channel_runs_with_the_normal_depth(slope, until, slack, figure, request):
    depth, discharge, passed = steady(slope, until)
    kind = request.node.callspec.id
    middle = slice(COLS // 4, COLS // 2)
    off = np.abs(depth[:, middle] / normal_depth(slope) - 1.0).max()
    figure(CASE, f"error of the normal depth, {kind}", off, below=1e-4, instead="round-off")
    figure(CASE, f"outflow per inflow, {kind}", passed, above=1.0 - slack, below=1.0 + slack)
    np.testing.assert_allclose(discharge[:, middle], DISCHARGE, rtol=1e-3)


EDGES = {
    "normal depth": {"kind": "normal_depth"},
    "stage": {"kind": "stage", "times": [0.0]},
    "open, fast": {"kind": "open"},
}


@pytest.mark.parametrize(
    ("outlet", "slope"),
    [("normal depth", 0.002), ("normal depth", 0.02), ("stage", 0.002), ("open, fast", 0.02)],
)
def test_discharge_through_an_edge_runs_with_the_normal_depth_from_end_to_end(outlet, slope, figure):
    """Dry at first; at the end no cell may be off, but where fast flow has entered at its critical depth."""
    h_n, what = normal_depth(slope), dict(EDGES[outlet])
    bed = np.broadcast_to(slope * DX * np.arange(COLS)[::-1], (ROWS, COLS)).astype(np.float32)
    if outlet == "normal depth":
        what["slope"] = slope
    elif outlet == "stage":
        what["values"] = [h_n - 0.5 * slope * DX]
    series = {"times": [0.0, 60.0], "values": [0.0, DISCHARGE * DX * ROWS]}
    edges = (
        EdgeBoundary("west", "discharge", 0, ROWS, **series),
        EdgeBoundary("east", first=0, last=ROWS, **what),
    )
    model = FloodModel(dx=DX, z_b=bed, manning_n=MANNING_N, boundaries=edges)
    solver = ShallowWaterSolver(model, SolverParams(), device="cpu")
    solver.set_water(np.zeros((ROWS, COLS), np.float32))
    solver.advance_to(6000.0)
    entry = 5 if 9.81 * h_n**3 < DISCHARGE**2 else 0
    off = np.abs(solver.depth()[:, entry:] / h_n - 1.0)
    name = f"discharge in, {outlet} out, slope {slope}"
    figure(CASE, f"largest error of the normal depth, {name}", off.max(), below=1e-4)
    assert abs(solver.budget().error_relative) < 2e-8


def test_roughness_wrong_by_a_thousandth_would_be_seen():
    assert abs(normal_depth(0.02, 1.001 * MANNING_N) / normal_depth(0.02) - 1.0) > 5.0 * 1e-4
