"""Steady channel flows driven through the edges: the solver under test and the published scheme on them."""

from collections.abc import Sequence

import numpy as np

from solver_service.numerics import EdgeBoundary, FloodModel, Rain, ShallowWaterSolver, SolverParams
from tests.validation.published_channel import simulate_channels
from tests.validation.runs import Array, State

ROWS = 2


def places(channel, cells: int, approach: int = 0) -> tuple[Array, float]:
    """Cell centres [m], ``approach`` of them before x = 0, and the cell size [m]."""
    dx = channel.length / cells
    return (np.arange(-approach, cells) + 0.5) * dx, dx


def is_fast(channel, x: float) -> bool:
    """Whether the exact flow is supercritical at a place."""
    h, u, _ = channel.state(np.array([x]), np.array([0.0]), 0.0)
    return bool(u[0] ** 2 > channel.gravity * h[0])


def edges(channel, x: Array, dx: float) -> tuple[EdgeBoundary, EdgeBoundary]:
    """The discharge comes in from the west; in the east stands the exact level, unless the flow is fast."""
    west = np.array([x[0] - 0.5 * dx])
    h, u, _ = channel.state(west, 0.0 * west, 0.0)
    inflow = EdgeBoundary("west", "discharge", 0, ROWS, times=[0.0], values=[(h * u)[0] * ROWS * dx])
    if is_fast(channel, channel.length):
        return inflow, EdgeBoundary("east", "open", 0, ROWS)
    east = np.array([channel.length])
    level = channel.state(east, 0.0 * east, 0.0)[0] + channel.bed(east, 0.0 * east)
    return inflow, EdgeBoundary("east", "stage", 0, ROWS, times=[0.0], values=level)


def steady(
    channel, cells: int, start: tuple[Array, Array], until: float, approach: int = 0, **params
) -> State:
    """Depth and velocity along the channel after ``until`` [s], from ``start``."""
    x, dx = places(channel, cells, approach)
    shape = (ROWS, x.size)
    rain = getattr(channel, "rain", 0.0)
    model = FloodModel(
        dx=dx,
        z_b=np.broadcast_to(channel.bed(x, 0.0 * x), shape),
        manning_n=getattr(channel, "manning_n", 0.0),
        boundaries=edges(channel, x, dx),
        rain=Rain.uniform([0.0], [rain], shape) if rain else None,
    )
    solver = ShallowWaterSolver(model, SolverParams(**params), device="cpu")
    h, u = (np.concatenate([np.full(approach, q[0]), q]) for q in start)
    solver.set_water(*(np.broadcast_to(q, shape).astype(np.float32) for q in (h, u, 0.0 * u)))
    solver.advance_to(until)
    assert abs(solver.budget().error_relative) < 1e-7
    assert np.ptp(solver.depth(), axis=0).max() == 0.0
    state = (solver.depth(), *solver.velocity())
    return tuple(q[0, approach:].astype(np.float64) for q in state)


def published(
    channels: Sequence, cells: int, begin: Sequence[tuple[Array, Array]], until: Sequence[float]
) -> list[State]:
    """The same runs with the published scheme."""
    return [(h, u, 0.0 * h) for h, u in simulate_channels(channels, cells, begin, until)]
