"""Small floods with every feature on, for tests."""

import numpy as np

from solver_service.numerics import (
    EdgeBoundary,
    FloodModel,
    Rain,
    ShallowWaterSolver,
    SolverParams,
    Source,
)

SHAPE = (70, 90)


def bed(shape=SHAPE, seed=1, roughness=0.5):
    """Hills, one of which stands out of the water, under random grain."""
    y, x = np.mgrid[0 : shape[0], 0 : shape[1]].astype(np.float32)
    z = 0.3 * np.sin(x / 7) * np.cos(y / 9) + 4.0 * np.exp(-((x - 45) ** 2 + (y - 30) ** 2) / 60)
    return (z + roughness * np.random.default_rng(seed).random(shape)).astype(np.float32)


def wild_water(z, seed=2):
    """A random state: deep and shallow water with random velocities, dry spots, a dry third."""
    rng = np.random.default_rng(seed)
    h = np.maximum(2.0 + np.where(np.arange(z.shape[1]) < 30, 2.0, 0.0) - z, 0.0) * (
        rng.random(z.shape) < 0.9
    )
    h[:, 60:] = 0.0
    u, v = rng.normal(0.0, 0.7, (2, *z.shape)) * (h > 0.0)
    return h.astype(np.float32), u.astype(np.float32), v.astype(np.float32)


def full_model(z=None, rain=True, seed=3):
    """Open edges, sources, rain, no-data cells and a roughness raster."""
    z = bed() if z is None else z
    rng = np.random.default_rng(seed)
    blocked = rng.random(z.shape) < 0.01
    blocked[20:23, 80:83] = False
    return FloodModel(
        dx=5.0,
        z_b=z,
        manning_n=(0.02 + 0.03 * rng.random(z.shape)).astype(np.float32),
        boundaries=(EdgeBoundary("west", "open", 10, 50), EdgeBoundary("north", "open", 20, 40)),
        sources=(Source([20, 20, 21], [80, 81, 80], [0.0, 4.0, 12.0], [0.0, 60.0, 20.0]),),
        rain=Rain.uniform([0.0, 8.0], [2e-5, 1e-4], z.shape) if rain else None,
        blocked=blocked,
    )


GAUGES = ((10.0, 12.0), (70.4, 33.3))


def solver(model, **params):
    """A solver of the model on the CPU."""
    return ShallowWaterSolver(model, SolverParams(**params), device="cpu")


def everything(s):
    """Every array that a solver can show."""
    m, g = s.maxima(), s.gauge_series()
    u, v = s.velocity()
    shown = {"h": s.depth(), "u": u, "v": v, "bed": s.bed, "gauge_h": g.h, "gauge_u": g.u, "gauge_eta": g.eta}
    shown |= {name: getattr(m, name) for name in m.__dataclass_fields__}
    shown["arrival_by_class"] = np.array(list(shown["arrival_by_class"].values()))
    budget = s.budget()
    shown["budget"] = np.array([budget.stored, budget.inflow, budget.outflow, budget.rain, budget.edits])
    shown["infiltrated"] = np.array([budget.infiltration])
    shown["clock"] = np.array([s.time, s.step_count, s.dt])
    return shown


def differences(a, b):
    """Names of what differs between two solvers in any bit."""
    left, right = everything(a), everything(b)
    return [name for name in left if not np.array_equal(left[name], right[name], equal_nan=True)]
