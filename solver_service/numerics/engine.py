"""What the two engines share: the parts of a run that a step touches, and the clock as the host sees it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

from solver_service.numerics.active_tiles import ActiveTiles
from solver_service.numerics.edges import Edges
from solver_service.numerics.fields import FieldStore, Scheme
from solver_service.numerics.gauges import GaugeRecorder
from solver_service.numerics.section_recorder import SectionRecorder
from solver_service.numerics.step_part import StepPart

StopQuestion = Callable[[], bool]


@dataclass(frozen=True)
class StepParts:
    """Everything a step works on."""

    store: FieldStore
    scheme: Scheme
    tiles: ActiveTiles
    after_step: tuple[StepPart, ...]
    """Applied in this order after every flux step."""
    gauges: GaugeRecorder
    sections: SectionRecorder
    """Measured after the flux step, before its parts change bed and water."""
    edges: Edges
    courant: float
    """cfl dx [m]."""
    dt_max: float
    dt_min: float


class Engine(ABC):
    """Takes steps. Time is float64; `wave_speed` is that of the active tiles after the last step."""

    def __init__(self, parts: StepParts) -> None:
        self.parts = parts
        self.time = 0.0
        self.dt = 0.0
        self.step_count = 0
        self.wave_speed = 0.0

    @abstractmethod
    def advance(self, target: float, should_stop: StopQuestion | None) -> bool:
        """Step until the clock shows exactly `target`; False when stopped before.

        Raises:
            StepCollapse: when stability asks for a step below `dt_min`.
        """


class StepCollapse(Exception):
    """Stability asks for a step below the floor; the solver turns this into a `SolverBlowUp`."""
