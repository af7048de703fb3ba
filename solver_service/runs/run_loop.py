"""The solver thread of a worker: obey commands between two steps, compute frames, hand them over.

A run is brought to where it goes on along its lineage: the newest state at hand (memory, disk, else time 0),
exact replay to the next branch point, the bed of the next leg, and so on until its own leg; from there every
output time becomes a frame. Frames that are stored already are computed again but not stored again.
"""

from __future__ import annotations

import gc
import time as clock
from collections.abc import Callable
from dataclasses import dataclass

from protocol import choose_depth_scale, limits
from solver_service.errors import ServiceError
from solver_service.numerics import pick_device
from solver_service.runs.computation import Computation
from solver_service.runs.frame_publisher import FramePublisher, QuantisedFrame
from solver_service.runs.inbox import Inbox
from solver_service.runs.state_keeper import StateKeeper
from solver_service.runs.worker_messages import (
    Begin,
    CaseLoaded,
    CaseRefused,
    Command,
    Failed,
    LoadCase,
    Pause,
    Paused,
    ProgressReport,
    Quit,
    Remark,
    Report,
    Running,
    SaveState,
    StateSaved,
    WorkerSettings,
)
from solver_service.store import CheckpointStore, DataFolder, RunDatabase, StoredState, save_bed

PROGRESS_INTERVAL_S = 0.25
REMEMBER_INTERVAL_S = 0.25
"""Wall time between states kept in memory: what a Recalculate may have to compute again."""
Q_FULL = 65535
"""A depth at the end of its scale: the frame is quantised again on a coarser one."""


class RunLoop:
    """Obeys commands until told to quit."""

    def __init__(self, settings: WorkerSettings, inbox: Inbox, report: Callable[[Report], None]) -> None:
        """Open the store.

        Args:
            settings: what the worker was told.
            inbox: the commands.
            report: sends a report; called from several threads.
        """
        self._settings = settings
        self._inbox = inbox
        self._report = report
        self._folder = DataFolder(settings.data_dir)
        self._database = RunDatabase(self._folder.database, settings.epoch)
        self._checkpoints = CheckpointStore(self._folder, self._database)
        self._publisher = FramePublisher(self._folder, settings.epoch, report, self._halt)
        self._keeper = StateKeeper(self._folder, settings.epoch, settings.ring_bytes, report)
        self._computation: Computation | None = None
        self._course: _Course | None = None
        self._halted = False

    def serve(self) -> None:
        """Work until Quit."""
        while True:
            computing = self._course is not None and self._course.computing and not self._halted
            command = self._inbox.next(wait=not computing)
            if isinstance(command, Quit):
                break
            try:
                if command is not None:
                    self._obey(command)
                else:
                    self._advance()
            except ServiceError as error:
                self._fail(str(error))
        self._leave()
        self._publisher.close()
        self._keeper.close()
        self._database.close()

    def _obey(self, command: Command) -> None:
        match command:
            case LoadCase():
                self._load_case(command)
            case Begin():
                self._begin(command)
            case Pause():
                self._pause(command)
            case SaveState():
                self._save_state(command)

    def _load_case(self, command: LoadCase) -> None:
        self._leave()
        try:
            computation = self._load(command.case, command.device)
            save_bed(self._folder, computation.fingerprint, computation.case.z_b)
        except ServiceError as error:
            self._report(CaseRefused(command.case, str(error)))
            return
        case = computation.case
        self._report(
            CaseLoaded(
                command.case,
                case.title,
                computation.fingerprint,
                computation.facts,
                case.duration,
                case.output_interval,
                computation.device,
            )
        )

    def _load(self, case: str, device: str) -> Computation:
        held = self._computation
        if held is None or (held.name, held.device) != (case, pick_device(device)):
            self._computation = held = None  # the memory first
            self._keeper.ring.clear()
            self._computation = held = Computation(case, device, self._settings.threads)
        return held

    def _begin(self, begin: Begin) -> None:
        self._halted = False
        self._publisher.retry()
        course = self._course
        if course is not None and course.begin.run == begin.run and self._computation is not None:
            course.computing = not course.finished
            self._report(Running(begin.run))
            return
        self._leave()
        self._course = course = _Course(begin)
        computation = self._load(begin.case, begin.device)
        if computation.fingerprint != begin.case_fingerprint:
            raise ServiceError(f"case {begin.case} has changed since run {begin.run} began; start a new run")
        course.position, state = self._nearest_state(begin)
        computation.restore(state)
        course.began_at = computation.solver.time
        course.wall_before = computation.elapsed_s
        course.steps_before = computation.solver.step_count
        course.next_index = _next_index(begin, course.position, computation.solver.time)
        course.computing = True
        self._report(Running(begin.run))

    def _nearest_state(self, begin: Begin) -> tuple[int, StoredState | None]:
        """The deepest leg of which a state is at hand, and the newest such state that is not too late."""
        for position in range(len(begin.legs) - 1, -1, -1):
            own = position == len(begin.legs) - 1
            until = (
                begin.stored_frames if own else begin.legs[position + 1].first_index
            ) * begin.output_interval
            run = begin.legs[position].run
            state = self._keeper.ring.latest(run, until)
            if state is None:
                state, damaged = self._checkpoints.latest(run, until)
                for sentence in damaged:
                    self._report(Remark(begin.run, f"{sentence}; an earlier one is used"))
            if state is not None:
                return position, state
        return 0, None

    def _advance(self) -> None:
        """Compute up to the next frame time, or until a command comes.

        A replay lands on every frame time too, as the first computation did: the time step is cut there.
        """
        course, computation = self._course, self._computation
        assert course is not None
        assert computation is not None
        begin = course.begin
        index = course.next_index
        if not computation.advance_to(index * begin.output_interval, self._should_stop):
            return
        while not course.is_own and begin.legs[course.position + 1].first_index == index:
            course.position += 1
            computation.enter(begin.legs[course.position])
        course.next_index = index + 1
        if not course.is_own:
            return
        if index >= begin.stored_frames:
            self._publish(course, computation, index)
        course.finished = index >= begin.last_index
        if course.finished or (begin.paused and index == begin.legs[-1].first_index):
            course.computing = False
        self._keep(course, computation)
        course.volume_error = computation.solver.budget().error_relative
        course.wet_cells = computation.solver.wet_cells
        self._progress(course, computation)
        if begin.paused and not course.computing and not course.finished:
            self._report(Paused(begin.run))

    def _publish(self, course: _Course, computation: Computation, index: int) -> None:
        if index >= course.group_end:
            course.scale = choose_depth_scale(float(computation.solver.depth().max(initial=0.0)))
            course.group_end = index + limits.FRAME_GROUP
        q, states = computation.quantise(course.scale)
        if q.max(initial=0) == Q_FULL:
            course.scale = choose_depth_scale(float(computation.solver.depth().max(initial=0.0)))
            course.group_end = index + limits.FRAME_GROUP
            q, states = computation.quantise(course.scale)
        leg = course.begin.legs[-1]
        frame = QuantisedFrame(leg.run, index, computation.solver.time, leg.revision, q, states, course.scale)
        self._publisher.publish(frame)

    def _keep(self, course: _Course, computation: Computation) -> None:
        """Remember the state of this frame, and write it to disk when that is due."""
        now = clock.perf_counter()
        due = course.checkpoint_at is None or now >= course.checkpoint_at or course.finished
        if not due and now < course.remember_at:
            return
        run, state = course.begin.run, computation.state()
        self._keeper.remember(run, state)
        course.remember_at = clock.perf_counter() + REMEMBER_INTERVAL_S
        if due:
            gc.collect()
            self._keeper.checkpoint(run, state)
            course.checkpoint_at = clock.perf_counter() + self._settings.checkpoint_interval_s

    def _pause(self, pause: Pause) -> None:
        course = self._course
        if course is None or course.begin.run != pause.run:
            return
        if pause.final:
            self._course = None
            return
        if course.computing and self._computation is not None and course.is_own:
            self._keeper.checkpoint(pause.run, self._computation.state())
        course.computing = False
        self._report(Paused(pause.run))

    def _leave(self) -> None:
        """Make sure that what is computed now can be taken up again elsewhere."""
        course, computation = self._course, self._computation
        if course is not None and computation is not None and course.computing and course.is_own:
            state = computation.state()
            self._keeper.remember(course.begin.run, state)
            self._keeper.checkpoint(course.begin.run, state)
        self._course = None

    def _save_state(self, command: SaveState) -> None:
        course = self._course
        state = None
        if course is not None:
            state = self._keeper.ring.latest(command.run, command.index * course.begin.output_interval)
        if state is None:
            self._report(StateSaved(command.run, command.index, False))
            return
        saved = StateSaved(command.run, command.index, True)
        self._keeper.checkpoint(command.run, state, lambda: self._report(saved))

    def _fail(self, message: str) -> None:
        """The run that is computed now cannot go on."""
        run = self._course.begin.run if self._course is not None else ""
        self._course = None
        self._computation = None
        self._report(Failed(run, message))

    def _halt(self, run: str, message: str) -> None:
        """A frame could not be stored (told by the publisher's thread): compute nothing more for now."""
        self._halted = True
        course = self._course
        for name in {run, course.begin.run if course is not None else run}:
            self._report(Paused(name, message))

    def _should_stop(self) -> bool:
        if self._inbox.pending or self._halted:
            return True
        course, computation = self._course, self._computation
        if course is not None and computation is not None and clock.perf_counter() >= course.progress_at:
            self._progress(course, computation)
        return False

    def _progress(self, course: _Course, computation: Computation) -> None:
        course.progress_at = clock.perf_counter() + PROGRESS_INTERVAL_S
        solver = computation.solver
        wall = max(computation.elapsed_s - course.wall_before, 1e-9)
        steps = solver.step_count - course.steps_before
        self._report(
            ProgressReport(
                run=course.begin.run,
                time=solver.time,
                steps=solver.step_count,
                dt=solver.dt,
                speed_x_real_time=(solver.time - course.began_at) / wall,
                wall_s=computation.elapsed_s,
                cell_steps_per_s=steps * computation.case.grid.cell_count / wall,
                volume_error_relative=course.volume_error,
                wet_cells=course.wet_cells,
            )
        )


@dataclass
class _Course:
    """Where the run of the moment is on its way.

    Attributes:
        begin: what was asked for.
        position: the leg of the lineage that is being computed.
        next_index: the next frame of the own leg.
        computing: whether to go on.
        finished: whether the last frame was handed over.
        scale: depth of one unit in the open group of frames [m].
        group_end: index at which the next group begins.
        remember_at: wall clock from which the next state is kept in memory.
        checkpoint_at: wall clock from which the next state goes to disk; None: the next one does.
        progress_at: wall clock of the next progress report.
        began_at: simulated time at which this stretch began [s].
        wall_before: wall time computed before this stretch [s].
        steps_before: solver steps before this stretch.
        volume_error: error of the volume budget at the last frame, relative.
        wet_cells: cells with water at the last frame.
    """

    begin: Begin
    position: int = 0
    next_index: int = 0
    computing: bool = False
    finished: bool = False
    scale: float = 0.0
    group_end: int = -1
    remember_at: float = 0.0
    checkpoint_at: float | None = None
    progress_at: float = 0.0
    began_at: float = 0.0
    wall_before: float = 0.0
    steps_before: int = 0
    volume_error: float = 0.0
    wet_cells: int = 0

    @property
    def is_own(self) -> bool:
        """Whether the leg that is computed is the run's own."""
        return self.position == len(self.begin.legs) - 1


def _next_index(begin: Begin, position: int, time: float) -> int:
    """The frame time to land on next: the first after `time`, or `time` itself if something is due there."""
    own = position == len(begin.legs) - 1
    due = begin.stored_frames if own else begin.legs[position + 1].first_index
    nearest = round(time / begin.output_interval)
    if nearest * begin.output_interval == time:
        return nearest if nearest >= due else nearest + 1
    return int(time // begin.output_interval) + 1
