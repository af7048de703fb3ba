"""GeoSWE on the common case: `python -m bench.peers.run_geoswe CELLS FILE`.

`Config()` is its production scheme: first order, HLLC, surface reconstruction, forward Euler, CFL 0.5. The
backend is the one that its environment has: CuPy on a GPU, else NumPy in float64. Arrays are [x, y].
"""

from __future__ import annotations

import sys
import time
from importlib.metadata import version

import geoswe
import numpy as np
from geoswe import Config, Mesh2D, Solver2D
from geoswe.backend import sync, to_host

from bench.peers import case


def main(cells: int, path: str) -> None:
    """Run and save."""
    x, y = case.centres(cells)
    dx = case.SIDE / cells
    config = Config(friction="manning", manning_n=case.MANNING_N, bc_x="wall", bc_y="wall", g=case.GRAVITY)
    start = np.zeros((3, cells, cells))
    start[0] = case.depth(x, y).T
    solver = Solver2D(Mesh2D(nx=cells, ny=cells, dx=dx, dy=dx), config, start, case.bed(x, y).T.copy())
    sync()
    cpu, wall = time.process_time(), time.perf_counter()
    steps = solver.run(t_end=case.END_TIME)
    sync()
    seconds = time.process_time() - cpu, time.perf_counter() - wall
    q = np.asarray(to_host(solver.q_interior), np.float64)
    volumes = float(start[0].sum()), float(q[0].sum())
    backend = "CuPy" if geoswe.backend.USING_CUPY else "NumPy"
    text = f"{version('geoswe')}, {backend}"
    case.save(path, (q[0].T, q[1].T, q[2].T), volumes, steps, seconds, text)


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2])
