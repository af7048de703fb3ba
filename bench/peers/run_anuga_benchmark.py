"""ANUGA on a validation benchmark: `python -m bench.peers.run_anuga_benchmark INPUT OUTPUT`.

INPUT is an .npz of `tests.validation.benchmarks.yardsticks`: bed, roughness, depth at the start, cell size,
places of the gauges, duration, interval of records, and either the series of the water level along the
western edge or that of a discharge into a rectangle. DE1 on as many triangles as there are cells; the other
edges are walls, or let water out where `open_edges` says so.
"""

from __future__ import annotations

import sys

import anuga
import numpy as np


def main(source: str, target: str) -> None:
    """Run and save times [s], depths and levels [m] and speeds [m/s] at the gauges."""
    anuga.set_omp_num_threads(1, verbose=False)
    given = np.load(source)
    bed, dx = given["bed"], float(given["dx"])
    nrows, ncols = bed.shape
    domain = anuga.rectangular_cross_domain(ncols // 2, nrows // 2, len1=ncols * dx, len2=nrows * dx)
    domain.set_flow_algorithm("DE1")
    domain.set_minimum_allowed_height(float(given["depth_dry"]))
    domain.set_store(False)
    x, y = domain.centroid_coordinates.T
    cell = np.clip((y / dx).astype(int), 0, nrows - 1), np.clip((x / dx).astype(int), 0, ncols - 1)
    z, h = (given[name][cell].astype(float) for name in ("bed", "depth"))
    roughness = np.full_like(z, float(given["manning_n"]))
    for name, values in (("elevation", z), ("friction", roughness), ("stage", z + h)):
        domain.set_quantity(name, values, location="centroids")
    wall = anuga.Reflective_boundary(domain)
    other = anuga.Transmissive_boundary(domain) if given["open_edges"] else wall
    west = wall
    times, values = given["times"], given["values"]
    if given["forcing"] == "stage":
        west = anuga.Transmissive_n_momentum_zero_t_momentum_set_stage_boundary(
            domain, lambda time: float(np.interp(time, times, values))
        )
    domain.set_boundary({"left": west, "right": other, "top": other, "bottom": other})
    if given["forcing"] == "discharge":
        (x0, y0), (x1, y1) = given["rectangle"]
        inlet = anuga.Region(domain, polygon=[[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
        anuga.Inlet_operator(domain, inlet, Q=lambda time: float(np.interp(time, times, values)))
    near = [np.argsort(np.hypot(x - a, y - b))[:4] for a, b in given["gauges"]]
    found: dict[str, list[object]] = {"times": [], "h": [], "level": [], "speed": []}
    for time in domain.evolve(yieldstep=float(given["interval"]), finaltime=float(given["duration"])):
        level, ground, hu, hv = (
            domain.quantities[name].centroid_values
            for name in ("stage", "elevation", "xmomentum", "ymomentum")
        )
        deep = level - ground
        speed = np.where(deep > 0.01, np.hypot(hu, hv) / np.maximum(deep, 0.01), 0.0)
        found["times"].append(time)
        for name, field in (("h", deep), ("level", level), ("speed", speed)):
            found[name].append([field[triangles].mean() for triangles in near])
    np.savez(target, **{name: np.array(values) for name, values in found.items()})


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
