"""ANUGA on the common case: `python -m bench.peers.run_anuga CELLS FILE`.

DE1: second order in space, two-step Runge-Kutta. As many triangles as the others have cells: squares of
twice the cell side, each cut by both diagonals. A cell of the common grid is a quarter of such a square,
half of one triangle and half of the next; its value is the mean of ANUGA's own linear reconstruction over it.
"""

from __future__ import annotations

import sys
import tempfile
import time
from importlib.metadata import version

import anuga
import numpy as np

from bench.peers import case


def quarters(
    values: case.Array, cells: int, triangles: case.Array, x: case.Array, y: case.Array
) -> case.Array:
    """Cell means [row, col] of a quantity given at the vertices of the triangles [triangle, 3]."""
    dx = case.SIDE / cells
    total, weight = np.zeros((cells, cells)), np.zeros((cells, cells))
    xs, ys = x[triangles], y[triangles]
    rows_of = np.arange(len(triangles))
    # The apex is the vertex in the middle of the square: an odd multiple of dx in both directions.
    apex = np.argmax((np.rint(xs / dx) % 2 == 1) & (np.rint(ys / dx) % 2 == 1), axis=1)
    for k in (1, 2):
        near, far = (apex + k) % 3, (apex + 3 - k) % 3
        top, one, other = (values[rows_of, vertex] for vertex in (apex, near, far))
        # The half beside `near` has the vertices apex, near and the middle of the long side.
        mean = (top + one + 0.5 * (one + other)) / 3.0
        cx = (xs[rows_of, apex] + xs[rows_of, near] + 0.5 * (xs[rows_of, near] + xs[rows_of, far])) / 3.0
        cy = (ys[rows_of, apex] + ys[rows_of, near] + 0.5 * (ys[rows_of, near] + ys[rows_of, far])) / 3.0
        index = (cy / dx).astype(int), (cx / dx).astype(int)
        np.add.at(total, index, mean)
        np.add.at(weight, index, 1.0)
    assert (weight == 2.0).all()
    return total / weight


def main(cells: int, path: str) -> None:
    """Run and save."""
    anuga.set_omp_num_threads(1, verbose=False)
    squares = cells // 2
    domain = anuga.rectangular_cross_domain(squares, squares, len1=case.SIDE, len2=case.SIDE)
    domain.set_flow_algorithm("DE1")
    domain.set_name("peers")
    domain.set_datadir(tempfile.gettempdir())
    domain.set_store(False)
    middle_x, middle_y = domain.centroid_coordinates.T
    z, h = case.bed(middle_x, middle_y), case.depth(middle_x, middle_y)
    for name, values in (("elevation", z), ("friction", np.full_like(z, case.MANNING_N)), ("stage", z + h)):
        domain.set_quantity(name, values, location="centroids")
    wall = anuga.Reflective_boundary(domain)
    domain.set_boundary(dict.fromkeys(("left", "right", "top", "bottom"), wall))
    before = domain.get_water_volume()
    cpu, clock, steps = time.process_time(), time.perf_counter(), 0
    for _ in domain.evolve(yieldstep=case.END_TIME, finaltime=case.END_TIME):
        steps += domain.number_of_steps
    seconds = time.process_time() - cpu, time.perf_counter() - clock
    volumes = before, domain.get_water_volume()
    domain.distribute_to_vertices_and_edges()
    triangles, (node_x, node_y) = domain.triangles, domain.nodes.T
    values = [domain.quantities[name].vertex_values for name in ("height", "xmomentum", "ymomentum")]
    fields = [quarters(value, cells, triangles, node_x, node_y) for value in values]
    case.save(path, tuple(fields), volumes, steps, seconds, version("anuga"))


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2])
