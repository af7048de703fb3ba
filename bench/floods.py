"""Floods of any size for the benches of the solver."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from solver_service.numerics import EdgeBoundary, FloodModel, Infiltration, Rain, SolverParams, Source

Water = list[np.ndarray]
"""h, u, v."""


def wavy_lake(side: int, wet: float = 1.0) -> tuple[FloodModel, Water]:
    """A lake over dunes with a hump and a swirl; the part `wet` of the columns carries water."""
    y, x = np.mgrid[0:side, 0:side].astype(np.float32)
    z = 0.3 * np.sin(x / 17) * np.cos(y / 23) + 0.5
    columns = round(wet * side)
    if columns < side:
        z[:, columns:] += 10.0
    n = 0.03 + 0.01 * np.sin(x / 40) * np.cos(y / 31)
    centre = columns // 2, side // 2
    h = np.maximum(4.0 - z, 0.0)
    h += 0.5 * np.exp(-((x - centre[0]) ** 2 + (y - centre[1]) ** 2) / (0.02 * side * columns)) * (h > 0.0)
    water = [h, 0.3 * np.sin(x / 50) * (h > 0.0), 0.2 * np.cos(y / 40) * (h > 0.0)]
    return FloodModel(10.0, z.astype(np.float32), n.astype(np.float32)), water


def lake_with_everything(side: int) -> tuple[FloodModel, Water, SolverParams]:
    """The lake with rain, infiltration, sources, driven edges, gauges and arrival times by depth class."""
    model, water = wavy_lake(side)
    times = np.array([0.0, 1e5])
    fifth = side // 5
    rates = np.full((2, 2, 2), 5e-6)
    half = (np.arange(side) * 2 // side).astype(np.int32)
    rows, cols = (index.ravel() for index in np.mgrid[fifth : fifth + 4, fifth : fifth + 4])
    model = replace(
        model,
        boundaries=(
            EdgeBoundary("west", "discharge", fifth, 2 * fifth, times=times, values=np.array([200.0, 200.0])),
            EdgeBoundary("east", "stage", fifth, 2 * fifth, times=times, values=np.array([4.0, 4.5])),
            EdgeBoundary("north", "open", fifth, 2 * fifth),
        ),
        sources=(Source(rows, cols, times, np.array([50.0, 60.0])),),
        rain=Rain(times, rates, half, half),
        infiltration=Infiltration("horton", None, {"f0": [1e-5], "fc": [1e-6], "k": [1e-3]}),
    )
    gauges = tuple((float(k), float(k)) for k in range(fifth, 4 * fifth, max(1, fifth // 4)))
    return model, water, SolverParams(gauges=gauges, arrival_depths=(0.15, 0.5, 1.0))
