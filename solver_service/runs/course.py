"""Where the run that a worker computes is on its way through the legs of its lineage."""

from __future__ import annotations

from dataclasses import dataclass, field

from solver_service.runs.frame_grouping import FrameGrouping
from solver_service.runs.worker_messages import Begin


@dataclass
class Course:
    """Where the run of the moment is on its way.

    Attributes:
        begin: what was asked for.
        position: the leg of the lineage that is being computed.
        next_index: the next frame of the own leg.
        computing: whether to go on.
        finished: whether the last frame was handed over.
        stored_end: frames of the own leg with an index below this are stored, or on their way.
        grouping: the group of frames that is open.
        remember_at: wall clock from which the next state is kept in memory.
        checkpoint_at: wall clock from which the next state goes to disk; None: the next one does.
        progress_at: wall clock of the next progress report.
        began_at: simulated time at which this stretch began [s].
        wall_before: wall time computed before this stretch [s].
        steps_before: solver steps before this stretch.
        volume_error: error of the volume budget at the last frame, relative.
        wet_cells: cells with water at the last frame.
        budget_at: wall clock of the next report of the volume budget.
        limiting_cell: row and column of the cell that limited dt at the last report.
    """

    begin: Begin
    position: int = 0
    next_index: int = 0
    computing: bool = False
    finished: bool = False
    stored_end: int = 0
    grouping: FrameGrouping = field(default_factory=FrameGrouping)
    remember_at: float = 0.0
    checkpoint_at: float | None = None
    progress_at: float = 0.0
    began_at: float = 0.0
    wall_before: float = 0.0
    steps_before: int = 0
    volume_error: float = 0.0
    wet_cells: int = 0
    budget_at: float = 0.0
    limiting_cell: tuple[int, int] | None = None

    @property
    def is_own(self) -> bool:
        """Whether the leg that is computed is the run's own."""
        return self.position == len(self.begin.legs) - 1

    @property
    def lacks_first_frame(self) -> bool:
        """Whether not even the first frame of the run is handed over."""
        return self.stored_end <= self.begin.legs[-1].first_index


def next_index_after(course: Course, time: float) -> int:
    """The frame time to land on next: the first after `time`, or `time` itself if something is due there."""
    begin = course.begin
    due = course.stored_end if course.is_own else begin.legs[course.position + 1].first_index
    nearest = round(time / begin.output_interval)
    if nearest * begin.output_interval == time:
        return nearest if nearest >= due else nearest + 1
    return int(time // begin.output_interval) + 1
