"""Numbers that choose and tune the scheme."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Literal

from solver_service.errors import ModelError
from solver_service.numerics.section import Section


@dataclass(frozen=True)
class SolverParams:
    """How a model is solved.

    Raises:
        ModelError: when a value is out of its range.
    """

    cfl: float = 0.45
    """Courant number of the faster direction [1], 0 < cfl <= 0.5."""
    order: Literal[1, 2] = 2
    """Order in space and time."""
    riemann: Literal["hllc", "hll"] = "hllc"
    """Riemann solver."""
    limiter_theta: float = 1.5
    """Generalised minmod parameter [1]: 1 is minmod, nearer 2 is sharper; 1 <= theta < 2."""
    depth_dry: float = 1e-3
    """Water no deeper than this has no velocity [m]."""
    depth_film: float = 1e-5
    """Water no deeper than this does not move at all [m]; at most depth_dry."""
    depth_cfl: float = 5e-3
    """Water no deeper than this never shortens the time step: it is no faster than the step allows [m]."""
    eddy_viscosity: float = 6.0
    """c in the eddy viscosity c u* h of the shear between streams [1]; 0 for none."""
    depth_arrival: float = 0.01
    """Depth at which water counts as arrived [m]."""
    arrival_depths: tuple[float, ...] = ()
    """Depth classes whose arrival times are kept besides [m], 4 bytes a cell each."""
    dt_max: float = math.inf
    """Largest time step [s]."""
    dt_min: float = 1e-6
    """A smaller step demanded by stability stops the run [s]."""
    threads: int | None = None
    """CPU threads; None takes every core that the process may use."""
    gauges: tuple[tuple[float, float], ...] = ()
    """(column, row) of each gauge in cells from the centre of cell (0, 0); the nearest cell is recorded."""
    gauge_interval: float = 1.0
    """Time between records of gauges and sections [s]."""
    sections: tuple[Section, ...] = ()
    """Lines through which the discharge is recorded, each id once."""
    engine: Literal["auto", "rows", "tiles", "kernels"] = "auto"
    """`rows` is the SIMD engine of CPUs, `tiles` that of GPUs, `kernels` steps cell by cell on either; all
    give the same bits."""

    def __post_init__(self) -> None:
        self._check("cfl", 0.0 < self.cfl <= 0.5, "0 < cfl <= 0.5")
        self._check("order", self.order in (1, 2), "1 or 2")
        self._check("riemann", self.riemann in ("hllc", "hll"), '"hllc" or "hll"')
        self._check("limiter_theta", 1.0 <= self.limiter_theta < 2.0, "1 <= limiter_theta < 2")
        self._check("depth_dry", 1e-6 <= self.depth_dry <= 0.1, "0.000001 to 0.1 m")
        self._check("depth_film", 1e-8 <= self.depth_film <= self.depth_dry, "0.00000001 m to depth_dry")
        self._check("depth_cfl", 0.0 <= self.depth_cfl <= 0.05, "0 to 0.05 m")
        self._check("eddy_viscosity", 0.0 <= self.eddy_viscosity <= 100.0, "0 to 100")
        self._check("depth_arrival", 0.0 < self.depth_arrival < math.inf, "a positive depth in m")
        depths_hold = all(0.0 < depth < math.inf for depth in self.arrival_depths)
        is_rising = all(a < b for a, b in itertools.pairwise(self.arrival_depths))
        self._check("arrival_depths", depths_hold and is_rising, "positive depths in m, each above the last")
        self._check("dt_min", 0.0 < self.dt_min < math.inf, "a positive time in s")
        self._check("dt_max", self.dt_max > self.dt_min, "a time in s larger than dt_min")
        self._check("threads", self.threads is None or self.threads >= 1, "None or at least 1")
        ids = [section.id for section in self.sections]
        self._check("sections", len(set(ids)) == len(ids), "each id once")
        self._check("gauge_interval", 0.0 < self.gauge_interval < math.inf, "a positive time in s")
        engines = ("auto", "rows", "tiles", "kernels")
        self._check("engine", self.engine in engines, '"auto", "rows", "tiles" or "kernels"')

    def _check(self, name: str, holds: bool, allowed: str) -> None:
        if not holds:
            raise ModelError(f"The solver parameter {name} is {getattr(self, name)!r}; allowed is {allowed}.")
