"""What a headless flight found out, as a file for programs and a table for people."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

from viewer.app.headless import HeadlessSession
from viewer.app.viewer_app import ViewerApp
from viewer.app.whole_file import write_whole
from viewer.view_status import time_text

__all__ = ["FlightSummary", "summarise", "table_text", "write_summary"]


@dataclass
class FlightSummary:
    """The figures of a headless flight; None where one is not known.

    Attributes:
        sim_time_s: simulation time computed by the run that was started [s].
        wall_s: wall time the solver needed for it, without its start [s].
        recalculate_latency_s: from Recalculate to the first frame of the recalculated run on the picture [s].
        recalculate_next_frame_s: from Recalculate to the frame after that [s].
        first_picture_s: from the start of the viewer to the first picture with water [s].
        changed_share: share of the pixels that differ between the pictures before and after.
        total_wall_s: from the start of the viewer to the end of the flight [s].
    """

    case: str | None = None
    title: str | None = None
    hypothetical: bool | None = None
    device: str | None = None
    cells: int | None = None
    cell_size_m: float | None = None
    steps: int | None = None
    sim_time_s: float | None = None
    wall_s: float | None = None
    speed_x_real_time: float | None = None
    cell_steps_per_s: float | None = None
    volume_error_relative: float | None = None
    recalculate_latency_s: float | None = None
    recalculate_next_frame_s: float | None = None
    first_picture_s: float | None = None
    changed_share: float | None = None
    total_wall_s: float | None = None
    pictures: list[str] = field(default_factory=list)
    contact_sheet: str | None = None


def summarise(app: ViewerApp, session: HeadlessSession, run: str | None, started: float) -> FlightSummary:
    """Return what is known of the flight.

    Args:
        app: the state machine.
        session: the flight.
        run: the run that was started first.
        started: wall time at which the viewer began [s, monotonic].
    """
    summary = FlightSummary(pictures=list(session.pictures))
    if session.first_picture_at is not None:
        summary.first_picture_s = round(session.first_picture_at - started, 3)
    info = app.desk.book.runs.get(run or "")
    if info is not None:
        summary.case, summary.title, summary.hypothetical = info.case, info.title, info.hypothetical
        summary.device = info.device
        summary.cells, summary.cell_size_m = info.grid.nrows * info.grid.ncols, info.grid.dx
    progress = app.desk.book.progress.get(run or "")
    if progress is not None:
        summary.steps, summary.sim_time_s, summary.wall_s = progress.steps, progress.time, progress.wall_s
        summary.speed_x_real_time = progress.speed_x_real_time
        summary.cell_steps_per_s = progress.cell_steps_per_s
        summary.volume_error_relative = progress.volume_error_relative
    begun = app.recalculated
    if begun is not None and begun.first_frame_s is not None:
        summary.recalculate_latency_s = round(begun.first_frame_s, 3)
    if begun is not None and begun.next_frame_s is not None:
        summary.recalculate_next_frame_s = round(begun.next_frame_s, 3)
    return summary


def write_summary(summary: FlightSummary, path: Path) -> None:
    """Write the figures as JSON; a half-written file never bears the name."""
    write_whole(path, (json.dumps(asdict(summary), indent=2) + "\n").encode())


def table_text(summary: FlightSummary) -> str:
    """Return the short table that is printed at the end of a flight."""
    rows = [("case", summary.title or summary.case)]
    if summary.cells is not None:
        rows.append(("cells", f"{summary.cells:,} of {summary.cell_size_m:g} m on {summary.device}"))
    if summary.steps is not None:
        rows.append(("steps", f"{summary.steps:,}"))
    if summary.sim_time_s is not None and summary.wall_s is not None:
        speed = f"{summary.speed_x_real_time:.0f} x real time"
        rows.append(("simulated", f"{time_text(summary.sim_time_s)} in {summary.wall_s:.1f} s, {speed}"))
    if summary.volume_error_relative is not None:
        rows.append(("water volume error", f"{summary.volume_error_relative:.1e}"))
    if summary.first_picture_s is not None:
        rows.append(("first picture", f"after {summary.first_picture_s:.1f} s"))
    if summary.recalculate_latency_s is not None:
        latency = f"first changed frame after {summary.recalculate_latency_s:.2f} s"
        if summary.recalculate_next_frame_s is not None:
            latency += f", the next after {summary.recalculate_next_frame_s:.2f} s"
        rows.append(("Recalculate", latency))
    if summary.changed_share is not None:
        rows.append(("picture changed", f"{100.0 * summary.changed_share:.1f} % of the pixels"))
    rows.append(("pictures", str(len(summary.pictures))))
    if summary.total_wall_s is not None:
        rows.append(("whole flight", f"{summary.total_wall_s:.1f} s"))
    widest = max(len(name) for name, _ in rows)
    return "\n".join(f"  {name:<{widest}}  {value}" for name, value in rows)
