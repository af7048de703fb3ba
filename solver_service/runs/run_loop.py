"""The solver thread of a worker: obey commands between two steps, compute frames, hand them over.

A run is brought to where it goes on along its lineage: the newest state at hand (memory, disk, else time 0),
exact replay to the next branch point, the bed of the next leg, and so on until its own leg; from there every
output time becomes a frame. Frames that are stored already are computed again but not stored again. A run is
never left without its first frame.
"""

from __future__ import annotations

import gc
import logging
import time as clock
from collections.abc import Callable
from dataclasses import replace

from protocol import ProtocolError
from solver_service.errors import ServiceError, StoreError, StoreFull
from solver_service.numerics import pick_device
from solver_service.runs.channels import due_channels
from solver_service.runs.computation import Computation
from solver_service.runs.course import Course, next_index_after
from solver_service.runs.forced_course import course_of
from solver_service.runs.frame_grouping import FrameGrouping, grouping_after, open_key_frame
from solver_service.runs.frame_publisher import FramePublisher
from solver_service.runs.frame_series import frame_series
from solver_service.runs.ground_layers import keep_layers
from solver_service.runs.inbox import Inbox
from solver_service.runs.quantised_frame import QuantisedFrame
from solver_service.runs.state_keeper import StateKeeper
from solver_service.runs.worker_failure import failure_of
from solver_service.runs.worker_messages import (
    Begin,
    BudgetReport,
    CaseLoaded,
    CaseRefused,
    Command,
    Failed,
    Left,
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
from solver_service.store import (
    CheckpointStore,
    DataFolder,
    FrameReader,
    RunDatabase,
    StoredState,
    save_bed,
)

LOG = logging.getLogger(__name__)

PROGRESS_INTERVAL_S = 0.25
BUDGET_INTERVAL_S = 1.0
REMEMBER_INTERVAL_S = 0.25
"""Wall time between states kept in memory: what a Recalculate may have to compute again."""


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
        self._reader = FrameReader(self._folder)
        self._publisher = FramePublisher(self._folder, settings.epoch, report, self._halt)
        self._keeper = StateKeeper(self._folder, settings.epoch, settings.ring_bytes, report)
        self._computation: Computation | None = None
        self._course: Course | None = None
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
                self._fail(error)
        self._leave(in_haste=True)
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
            keep_layers(self._folder, computation.fingerprint, computation.case)
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
        is_there = held is not None and (device == "auto" or held.device == pick_device(device))
        if held is None or held.name != case or not is_there:
            self._computation = held = None  # the memory first
            self._keeper.ring.clear()
            self._computation = held = Computation(case, device, self._settings.threads)
        return held

    def _begin(self, begin: Begin) -> None:
        self._halted = False
        self._publisher.retry()
        course = self._course
        if course is not None and course.begin.run == begin.run and self._computation is not None:
            course.begin = replace(course.begin, paused=begin.paused, number=begin.number)
            course.computing = not course.finished
            self._report(Running(begin.run))
            return
        self._leave()
        if not self._publisher.settle():
            full = "frames of another run wait for room on the disk"
            self._report(Paused(begin.run, full, lacks_room=True))
            self._report(Left(begin.run, begin.number))
            return
        self._course = course = Course(begin)
        computation = self._load(begin.case, begin.device)
        if computation.fingerprint != begin.case_fingerprint:
            raise ServiceError(f"case {begin.case} has changed since run {begin.run} began; start a new run")
        last = self._database.last_frame(begin.run)
        course.stored_end = last.index + 1 if last is not None else begin.legs[-1].first_index
        course.grouping = self._open_grouping(begin.run)
        course.position, state = self._nearest_state(course)
        computation.restore(state, course_of(begin.legs[: course.position + 1], begin.output_interval))
        course.began_at = computation.solver.time
        course.wall_before = computation.elapsed_s
        course.steps_before = computation.solver.step_count
        course.next_index = next_index_after(course, computation.solver.time)
        course.computing = True
        LOG.info("computing on %s from %g s", computation.device, computation.solver.time)
        self._report(Running(begin.run))

    def _open_grouping(self, run: str) -> FrameGrouping:
        try:
            return grouping_after(open_key_frame(self._database, self._reader, run))
        except (StoreError, ProtocolError) as error:
            self._report(Remark(run, f"{error}; the next frame begins a group"))
            return FrameGrouping()

    def _nearest_state(self, course: Course) -> tuple[int, StoredState | None]:
        """The deepest leg of which a state is at hand, and the newest such state that is not too late."""
        begin = course.begin
        for position in range(len(begin.legs) - 1, -1, -1):
            own = position == len(begin.legs) - 1
            until = (
                course.stored_end if own else begin.legs[position + 1].first_index
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

    def _advance(self, should_stop: Callable[[], bool] | None = None) -> None:
        """Compute up to the next frame time, or until a command comes.

        A replay lands on every frame time too, as the first computation did: the time step is cut there.
        """
        course, computation = self._course, self._computation
        assert course is not None
        assert computation is not None
        begin = course.begin
        index = course.next_index
        if not computation.advance_to(index * begin.output_interval, should_stop or self._should_stop):
            return
        while not course.is_own and begin.legs[course.position + 1].first_index == index:
            # whoever branches here again, as people do who press Recalculate twice, finds the state at hand
            past = begin.legs[course.position].run
            if computation.solver.time not in self._keeper.ring.times(past):
                self._keeper.remember(past, computation.state())
            course.position += 1
            legs = begin.legs[: course.position + 1]
            told = computation.enter(legs[-1], course_of(legs, begin.output_interval))
            if len(legs) == len(begin.legs):  # its own leg: what an ancestor was told is old news
                for sentence in told:
                    self._report(Remark(begin.run, sentence))
        course.next_index = index + 1
        if not course.is_own:
            return
        if index >= course.stored_end:
            self._publish(course, computation, index)
            course.stored_end = index + 1
        course.finished = index >= begin.last_index
        if course.finished or (begin.paused and index == begin.legs[-1].first_index):
            course.computing = False
        self._keep(course, computation)
        if course.finished:
            self._let_go(course)  # the states stay in memory for whoever branches
        self._take_stock(course, computation)
        self._progress(course, computation)
        if begin.paused and not course.computing and not course.finished:
            self._report(Paused(begin.run, number=begin.number))

    def _publish(self, course: Course, computation: Computation, index: int) -> None:
        q, states, scale = course.grouping.quantise(index, computation.quantise, computation.depth_max)
        leg = course.begin.legs[-1]
        solver = computation.solver
        bed = solver.breached_bed()
        due = due_channels(course.begin.channels, index, leg.first_index, course.begin.last_index)
        channels = {name: computation.channel(name) for name in due}
        series = frame_series(computation.case, solver, leg.run, index, course.begin.output_interval)
        water, depth_wet = (q, states, scale), computation.depth_wet
        frame = QuantisedFrame(
            leg.run, index, solver.time, leg.revision, *water, bed, channels, series, depth_wet
        )
        self._publisher.publish(frame)

    def _keep(self, course: Course, computation: Computation) -> None:
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
            self._let_go(course)
            return
        if course.computing and course.lacks_first_frame:
            course.begin = replace(course.begin, paused=True)  # it pauses by itself at its first frame
            return
        if course.computing and self._computation is not None and course.is_own:
            self._keeper.checkpoint(pause.run, self._computation.state())
        course.computing = False
        self._report(Paused(pause.run, number=course.begin.number))

    def _leave(self, in_haste: bool = False) -> None:
        """Make sure that what is computed now can be taken up again elsewhere."""
        course, computation = self._course, self._computation
        if course is None:
            return
        run = course.begin.run
        if not in_haste:
            while course.computing and course.lacks_first_frame and not self._hurry():
                try:
                    self._advance(self._hurry)
                except ServiceError as error:
                    self._fail(error)
                    return
        if computation is not None and course.computing and course.is_own:
            state = computation.state()
            self._keeper.remember(run, state)
            self._keeper.checkpoint(run, state)
        self._course = None
        self._let_go(course)

    def _hurry(self) -> bool:
        return self._inbox.quitting or self._halted

    def _let_go(self, course: Course) -> None:
        """Tell it once nothing of a run is on its way to the disk any more."""
        left = Left(course.begin.run, course.begin.number)
        self._publisher.then(lambda: self._keeper.then(lambda: self._report(left)))

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

    def _fail(self, error: ServiceError) -> None:
        """The run that is computed now cannot go on."""
        course, run = self._course, self.run
        self._course = None
        self._computation = None
        self._report(Failed(run, *failure_of(error)))
        if course is not None:
            self._let_go(course)

    @property
    def run(self) -> str:
        """The run that is computed now, or nothing."""
        return self._course.begin.run if self._course is not None else ""

    def _halt(self, run: str, error: StoreError) -> None:
        """A frame could not be stored (told by the publisher's thread): compute nothing more for now."""
        self._halted = True
        for name in {run, self.run or run}:
            self._report(Paused(name, str(error), isinstance(error, StoreFull)))

    def _should_stop(self) -> bool:
        if self._inbox.pending or self._halted:
            return True
        course, computation = self._course, self._computation
        if course is not None and computation is not None and clock.perf_counter() >= course.progress_at:
            self._progress(course, computation)
        return False

    def _take_stock(self, course: Course, computation: Computation) -> None:
        """What is too dear to be asked for between two frames."""
        now = clock.perf_counter()
        budget = computation.solver.budget()
        course.volume_error = budget.error_relative
        course.wet_cells = computation.solver.wet_cells
        if course.finished or now >= course.budget_at:
            course.budget_at = now + BUDGET_INTERVAL_S
            course.limiting_cell = computation.solver.limiting_cell()
            self._report(BudgetReport(course.begin.run, computation.solver.time, budget.as_dict()))

    def _progress(self, course: Course, computation: Computation) -> None:
        course.progress_at = clock.perf_counter() + PROGRESS_INTERVAL_S
        solver = computation.solver
        wall = max(computation.elapsed_s - course.wall_before, 1e-9)
        steps = solver.step_count - course.steps_before
        speed = (solver.time - course.began_at) / wall
        left = course.begin.last_index * course.begin.output_interval - solver.time
        self._report(
            ProgressReport(
                run=course.begin.run,
                time=solver.time,
                steps=solver.step_count,
                dt=solver.dt,
                speed_x_real_time=speed,
                wall_s=computation.elapsed_s,
                cell_steps_per_s=steps * computation.case.grid.cell_count / wall,
                volume_error_relative=course.volume_error,
                wet_cells=course.wet_cells,
                limiting_cell=course.limiting_cell,
                eta_s=max(left, 0.0) / speed if speed > 0.0 else None,
            )
        )
