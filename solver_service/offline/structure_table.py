"""What passed structures and breaches, recorded at the output times: one line for each time and structure."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from solver_service.numerics import ShallowWaterSolver
from solver_service.numerics.structures import Weir
from solver_service.offline.series_tables import quoted
from solver_service.scenario import Case
from solver_service.scenario.places import structure_section

COLUMNS = "time_s,structure,discharge_m3_s,moved_m3,width_m,level_m"


class StructureLog:
    """Lines of the table, in the order in which they happened.

    Args:
        case: its structures and breaches are recorded.
    """

    def __init__(self, case: Case) -> None:
        self.lines: list[str] = []
        self._datum = case.grid.datum_offset
        self._weirs = [built for built in case.model.structures if isinstance(built, Weir)]
        self._breaches = case.model.breaches
        self._before: dict[str, tuple[float, float]] = {}

    def record(self, solver: ShallowWaterSolver) -> None:
        """Add a line for each weir, culvert, pump and breach at the solver's time."""
        states = {state.id: state for state in solver.breach_states()}
        for name, moved in self._moved(solver):
            time_before, moved_before = self._before.get(name, (solver.time, moved))
            self._before[name] = (solver.time, moved)
            elapsed = solver.time - time_before
            discharge = (moved - moved_before) / elapsed if elapsed > 0.0 else 0.0
            line = f"{solver.time:.10g},{quoted(name)},{discharge:.6g},{moved:.8g}"
            state = states.get(name)
            size = f"{state.width:.4f},{state.level + self._datum:.4f}" if state else ","
            self.lines.append(f"{line},{size}")

    def _moved(self, solver: ShallowWaterSolver) -> Iterator[tuple[str, float]]:
        """Name and volume so far [m3] of each structure."""
        passed = {totals.id: totals.volume for totals in solver.section_totals()}
        for weir in self._weirs:
            yield weir.id, passed[structure_section(weir)]
        for state in solver.conduit_states():
            yield state.id, state.moved
        for breach in self._breaches:
            yield breach.id, passed[structure_section(breach)]


def write_structures(path: Path, log: StructureLog) -> None:
    """Write the table.

    Raises:
        OSError: the file cannot be written.
    """
    path.write_text("\n".join([COLUMNS, *log.lines, ""]), encoding="utf-8", newline="\n")
