"""landlab's OverlandFlow on the common case: `python -m bench.peers.run_landlab CELLS FILE`.

Local inertia (de Almeida et al. 2012), without advection of momentum. A ring of closed nodes is the wall.
`steep_slopes` limits discharge to the critical one; without it depths fall to -6 m.
"""

from __future__ import annotations

import sys
import time
from importlib.metadata import version

import numpy as np
from landlab import RasterModelGrid
from landlab.components import OverlandFlow

from bench.peers import case


def main(cells: int, path: str) -> None:
    """Run and save."""
    x, y = case.centres(cells)
    grid = RasterModelGrid((cells + 2, cells + 2), xy_spacing=case.SIDE / cells)
    grid.set_closed_boundaries_at_grid_edges(True, True, True, True)
    for name, values in (
        ("topographic__elevation", case.bed(x, y)),
        ("surface_water__depth", case.depth(x, y)),
    ):
        grid.add_field(name, np.pad(values, 1, mode="edge").ravel(), at="node")
    grid.at_node["surface_water__depth"][grid.boundary_nodes] = 0.0
    flow = OverlandFlow(grid, mannings_n=case.MANNING_N, g=case.GRAVITY, steep_slopes=True)
    before = float(grid.at_node["surface_water__depth"][grid.core_nodes].sum())
    steps, elapsed = 0, 0.0
    cpu, wall = time.process_time(), time.perf_counter()
    while elapsed < case.END_TIME:
        dt = min(flow.calc_time_step(), case.END_TIME - elapsed)
        flow.overland_flow(dt=dt)
        elapsed += dt
        steps += 1
    seconds = time.process_time() - cpu, time.perf_counter() - wall
    h = grid.at_node["surface_water__depth"].reshape(cells + 2, cells + 2)[1:-1, 1:-1]
    links = grid.at_link["surface_water__discharge"][grid.links_at_node]  # east, north, west, south
    inner = [links[:, k].reshape(cells + 2, cells + 2)[1:-1, 1:-1] for k in range(4)]
    fields = (h, 0.5 * (inner[0] + inner[2]), 0.5 * (inner[1] + inner[3]))
    volumes = before, float(h.sum())
    case.save(path, fields, volumes, steps, seconds, version("landlab"))


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2])
