"""The published scheme in channels with inflow, outflow, friction and rain; many channels in one run.

The scheme is that of ``published_scheme.py``; each row is a channel of its own with its own cells, time step
and end. The edges are those of FullSWOF (Delestre et al. 2017, following Bristeau and Coussin 2001, INRIA
report 4282): what is given is given, the rest follows from the invariant u -+ 2 c that leaves the channel::

    inflow, subcritical     q given, h from q / h - 2 c(h) = u_1 - 2 c_1        supercritical: q and h given
    outflow, subcritical    h given, u = u_1 + 2 (c_1 - c(h))                   supercritical: copied

Behind the edges the bed goes on as it comes (FullSWOF continues it level, which costs it a centimetre in the
first cells of a sloping channel and would flatter the solver under test).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tests.validation.published_scheme import CFL, GRAVITY, dragged, positive, rate_along_x, velocity

Array = NDArray[np.float64]


class _Edges:
    """Ghost water of all channels, from what their solutions say at the ends."""

    def __init__(self, channels: Sequence) -> None:
        ends = np.array([[0.0, channel.length] for channel in channels])
        states = [channel.state(x, 0.0 * x, 0.0) for channel, x in zip(channels, ends, strict=True)]
        (self.h_in, self.h_out), (u_in, u_out) = np.array([(h, u) for h, u, _ in states]).transpose(1, 2, 0)
        self.q_in = self.h_in * u_in
        self.fast_in, self.fast_out = (
            u > np.sqrt(GRAVITY * h) for u, h in ((u_in, self.h_in), (u_out, self.h_out))
        )

    def inflow(self, h: Array, u: Array) -> tuple[Array, Array]:
        """Depth and velocity of the western ghosts."""
        leaving, depth = u - 2.0 * np.sqrt(GRAVITY * h), h.copy()
        for _ in range(12):  # Newton's method
            c = np.sqrt(GRAVITY * depth)
            value = depth * (leaving + 2.0 * c) - self.q_in
            depth = np.maximum(depth - value / np.maximum(leaving + 3.0 * c, 1e-3), 1e-4)
        depth = np.where(self.fast_in, self.h_in, depth)
        return depth, self.q_in / depth

    def outflow(self, h: Array, u: Array) -> tuple[Array, Array]:
        """Depth and velocity of the eastern ghosts."""
        fast = self.fast_out | (u > np.sqrt(GRAVITY * h))
        c, c_out = np.sqrt(GRAVITY * h), np.sqrt(GRAVITY * self.h_out)
        return np.where(fast, h, self.h_out), np.where(fast, u, u + 2.0 * (c - c_out))

    def pad(self, h: Array, u: Array) -> tuple[Array, Array]:
        """Depth and velocity with two ghosts at each end."""
        h_w, u_w = self.inflow(h[:, 0], u[:, 0])
        h_e, u_e = self.outflow(h[:, -1], u[:, -1])
        return (
            np.column_stack([west, west, inside, east, east])
            for west, inside, east in ((h_w, h, h_e), (u_w, u, u_e))
        )


def simulate_channels(
    channels: Sequence, cells: int, starts: Sequence[tuple[Array, Array]], until: Sequence[float]
) -> list[tuple[Array, Array]]:
    """Advance depth [m] and velocity [m/s] of every channel to its own time ``until`` [s]."""
    dx = np.array([[channel.length / cells] for channel in channels])
    x = (np.arange(cells) + 0.5) * dx
    bed = np.array([channel.bed(row, 0.0 * row) for channel, row in zip(channels, x, strict=True)])
    bed = np.pad(bed, ((0, 0), (2, 2)), mode="reflect", reflect_type="odd")
    drag, rain = (
        np.array([[getattr(channel, name, 0.0)] for channel in channels]) for name in ("manning_n", "rain")
    )
    drag = GRAVITY * drag**2
    edges = _Edges(channels)

    def step(state: Array, dt: Array) -> Array:
        h, u = state[0], velocity(state[0], state[1])
        h_all, u_all = edges.pad(h, u)
        mass, along, across = rate_along_x(h_all, u_all, 0.0 * u_all, bed, dx)
        return dragged(positive(state + dt * np.array([mass + rain, along, across])), u, 0.0 * u, drag, dt)

    h, u = (np.array(part) for part in zip(*starts, strict=True))
    state, left = np.array([h, h * u, 0.0 * h]), np.array(until, dtype=np.float64)[:, None]
    while left.any():
        speed = np.abs(velocity(state[0], state[1])) + np.sqrt(GRAVITY * state[0])
        dt = np.minimum(CFL * dx / speed.max(axis=1, keepdims=True), left)
        state = positive(0.5 * (state + step(step(state, dt), dt)))
        left -= dt
    return list(zip(state[0], velocity(state[0], state[1]), strict=True))
