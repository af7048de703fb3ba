"""What structures and breaches did, recorded at the output times: one line for each time and structure."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from solver_service.numerics import ShallowWaterSolver
from solver_service.offline.series_tables import quoted

COLUMNS = "time_s,structure,discharge_m3_s,moved_m3,width_m,level_m"


@dataclass
class StructureLog:
    """Lines of the table, in the order in which they happened.

    Attributes:
        datum_offset: elevation that the solver's levels are relative to [m].
        lines: text of each line.
    """

    datum_offset: float
    lines: list[str] = field(default_factory=list)

    def record(self, solver: ShallowWaterSolver) -> None:
        """Add a line for each culvert, pump and breach at the solver's time."""
        time = f"{solver.time:.10g}"
        for state in solver.conduit_states():
            self.lines.append(f"{time},{quoted(state.id)},{state.discharge:.6g},{state.moved:.6g},,")
        for breach in solver.breach_states():
            level = breach.level + self.datum_offset
            self.lines.append(f"{time},{quoted(breach.id)},,,{breach.width:.4f},{level:.4f}")


def write_structures(path: Path, log: StructureLog) -> None:
    """Write the table; discharge and volume of culverts and pumps, width and bottom level of breaches.

    Raises:
        OSError: the file cannot be written.
    """
    path.write_text("\n".join([COLUMNS, *log.lines, ""]), encoding="utf-8", newline="\n")
