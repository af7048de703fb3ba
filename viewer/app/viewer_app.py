"""The viewer's state machine, the same behind the window and off screen; knows no toolkit.

Commands and time go in, a status and the inputs of a picture come out. Everything here runs on the thread
that draws; the network and the decoding have threads of their own and are met at bounded boxes.
"""

from __future__ import annotations

import dataclasses
import math
import time as wall_clock

import protocol
from viewer.app.camera_work import CameraWork
from viewer.app.editing import Editing
from viewer.app.picture_text import edit_overlay, hud_text
from viewer.app.recalculation import Recalculation
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.app.status_report import point_readout, program_status, run_status
from viewer.app.view_options import changed_options
from viewer.app.water_feed import WaterFeed
from viewer.commands import (
    Command,
    CommandError,
    FollowLive,
    MoveHover,
    Pause,
    PauseRun,
    Play,
    ProbeAt,
    Recalculate,
    ResumeRun,
    SavePicture,
    Seek,
    SelectRun,
    SetOption,
    SetSpeed,
    StartRun,
    StopRun,
)
from viewer.errors import ViewerError
from viewer.net import ConnectionThread, FrameLoader
from viewer.render import FrameInputs, RenderOptions
from viewer.view_status import ViewStatus
from viewer.world import Heightfield, PlaybackClock

__all__ = ["ViewerApp"]

PLAYBACK_LENGTH_S = 60.0
"""Wall time in which a whole run plays at the speed chosen first [s]."""
STATUS_PERIOD_S = 0.1
"""The status is made anew at most this often while only time passes [s]."""


class ViewerApp:
    """The program behind the window.

    Args:
        connection: a started or startable connection to the service; closed by `close`.
        loader: keeps and decodes frames; closed by `close`.
        autostart: case to start once the connection stands, None to start nothing.
    """

    def __init__(
        self, connection: ConnectionThread, loader: FrameLoader, autostart: StartRun | None = None
    ) -> None:
        self.desk = ServiceDesk(connection, self)
        self.loader = loader
        self.clock = PlaybackClock()
        self.options = RenderOptions()
        self.shown: ShownRun | None = None
        self.camera_work: CameraWork | None = None
        self.recalculated: Recalculation | None = None
        self.editing = Editing(self.desk)
        self.editing.refused = self._forget_recalculate
        self.feed = WaterFeed(loader, self.desk.book, self._request_frame)
        self.message = ""
        self._autostart = autostart
        self._awaited_run: str | None = None
        self._recalculate_wanted = False
        self._picture_path: str | None = None
        self._hover_at: tuple[float, float] | None = None
        self._probe_at: tuple[float, float] | None = None
        self._last_advance: float | None = None
        self._picture_stale = True
        self._status_stale = True
        self._status_made = -math.inf
        self._status = ViewStatus()

    # --- commands ---------------------------------------------------------------------------------

    def dispatch(self, command: Command) -> None:
        """Carry out a command; what goes wrong is told in the status message."""
        self._picture_stale = self._status_stale = True
        try:
            self.carry_out(command)
        except (ViewerError, protocol.ProtocolError) as error:
            self.say(str(error))

    def carry_out(self, command: Command) -> None:
        """Carry out a command.

        Raises:
            CommandError: it makes no sense now; nothing was changed.
        """
        match command:
            case Play():
                self.clock.play()
            case Pause():
                self.clock.pause()
            case Seek(time):
                if not math.isfinite(time):
                    raise CommandError(f"Seek.time = {time!r} is not allowed; it must be finite")
                self.clock.seek(min(time, self._require_run().computed_until))
            case SetSpeed(factor):
                if not (math.isfinite(factor) and factor > 0.0):
                    raise CommandError(f"SetSpeed.factor = {factor!r} is not allowed; it must be above 0")
                self.clock.set_speed(factor)
            case FollowLive(on):
                self.clock.follow_live() if on else self.clock.pause()
            case StartRun():
                self._start_run(command)
            case SelectRun(run):
                self._select_run(run)
            case PauseRun(run):
                self.desk.pause_run(run or self._require_run().run)
            case ResumeRun(run):
                self.desk.resume_run(run or self._require_run().run)
            case StopRun(run):
                self.desk.stop_run(run or self._require_run().run)
            case SetOption(name, value):
                self.options = changed_options(self.options, name, value)
                if self.camera_work is not None:
                    self.camera_work.set_exaggeration(self.options.exaggeration)
            case ProbeAt(x, y):
                self._probe_at = (x, y)
            case MoveHover(x, y):
                self._hover_at = None if x is None or y is None else (x, y)
                self.editing.hover(self._hover_at, self.shown)
            case SavePicture(path):
                self._picture_path = path
            case Recalculate():
                self._recalculate()
            case _:
                if not self.editing.carry_out(command, self.shown) and (
                    self.camera_work is None or not self.camera_work.carry_out(command)
                ):
                    raise CommandError(f"{type(command).__name__} is not possible before a terrain is shown")

    def _start_run(self, command: StartRun) -> None:
        def started(result: object) -> None:
            assert isinstance(result, dict)
            self._awaited_run = str(result["run"])
            self.clock.seek(0.0)
            self.clock.follow_live()
            info = self.desk.book.runs.get(self._awaited_run)
            if info is not None:
                self.run_changed(info)

        self.say(f"starting {command.case} ...")
        self.desk.start_run(
            command.case,
            command.duration,
            command.output_interval,
            command.device,
            started,
            lambda _reason: None,
        )

    def _select_run(self, run: str) -> None:
        info = self.desk.book.runs.get(run)
        if info is None:
            raise CommandError(f"run {run!r} is unknown")
        self._awaited_run = run
        self.run_changed(info)

    def _recalculate(self) -> None:
        shown = self._require_run()
        if self.recalculated is not None and self.recalculated.is_waiting:
            raise CommandError("a recalculation is under way already")
        if shown.info.frame_count == 0 and len(shown.timeline) == 0:
            raise CommandError("there is no computed frame to recalculate from yet")
        if self.editing.unconfirmed is not None:
            self._recalculate_wanted = True
            return
        self._recalculate_wanted = False
        newest = max(shown.info.frame_count - 1, shown.timeline.index_before(shown.timeline.last_time))
        index = min(shown.timeline.index_before(self.clock.time), newest)
        document = shown.document
        begun = Recalculation(
            shown.run, index, document.edits, wall_clock.monotonic(), self.clock.follows_live
        )
        self.recalculated = begun

        def done(result: object) -> None:
            assert isinstance(result, dict)
            begun.child = str(result["run"])
            self.desk.book.applied[begun.child] = begun.edits
            self._awaited_run = begun.child
            info = self.desk.book.runs.get(begun.child)
            if info is not None:
                self.run_changed(info)

        def refused(_reason: str) -> None:
            self.recalculated = None

        self.desk.recalculate(shown.run, index, document.revision, done, refused)
        self.say("recalculating ...")

    # --- what the service says ----------------------------------------------------------------------

    def connection_opened(self) -> None:
        """Take up where the lost connection was, or start what was asked for at the beginning."""
        self._status_stale = True
        self.message = ""
        if self.shown is not None:
            self._subscribe(self.shown)
        elif self._autostart is not None:
            command, self._autostart = self._autostart, None
            self.dispatch(command)

    def run_changed(self, info: protocol.RunInfo) -> None:
        """Follow a change of the shown run; show the run that is waited for."""
        self._status_stale = self._picture_stale = True
        if self.shown is not None and info.run == self.shown.run:
            self.shown.info = info
        if info.run == self._awaited_run and (self.shown is None or info.run != self.shown.run):
            self._show(info)

    def edits_changed(self, message: protocol.EditsChanged) -> None:
        """Take over the working list of the shown run."""
        self._status_stale = self._picture_stale = True
        shown = self.shown
        if shown is None or message.run != shown.run:
            return
        self.editing.note_edits(message, shown)
        if self._recalculate_wanted and self.editing.unconfirmed is None:
            self.dispatch(Recalculate())

    def terrain_came(self, message: protocol.TerrainReceived) -> None:
        """Show the run whose terrain was waited for."""
        info = self.desk.book.runs.get(message.run)
        if info is None or message.run != self._awaited_run:
            return
        self._enter(ShownRun(info, message.z_b, self.loader), is_other_terrain=True)
        assert self.shown is not None
        self.camera_work = CameraWork(
            self.shown.heightfield,
            self.options.exaggeration,
            16.0 / 9.0 if self.camera_work is None else self.camera_work.aspect,
        )
        self.clock.set_speed(max(1.0, info.duration / PLAYBACK_LENGTH_S))

    def say(self, sentence: str) -> None:
        """Show a sentence in the status line."""
        self.message = sentence
        self._status_stale = True

    complain = say

    # --- time ---------------------------------------------------------------------------------------

    def advance(self, now: float) -> bool:
        """Move on to wall time `now` [s, monotonic]; return whether the picture has changed."""
        wall_dt = 0.0 if self._last_advance is None else max(0.0, now - self._last_advance)
        self._last_advance = now
        connected_before = self._status.is_connected
        for frame in self.desk.drain():
            self._take_frame(frame)
        if self.desk.is_open != connected_before or not self.desk.is_open:
            self._status_stale = True
        changed = self._picture_stale
        self._picture_stale = False
        shown = self.shown
        if shown is not None and self.camera_work is not None:
            changed |= self.camera_work.advance(wall_dt)
            changed |= shown.refresh_ground()
            changed |= self._advance_clock(shown, wall_dt)
            if not self._is_held:
                changed |= self.feed.advance(shown, self.clock.time)
        if changed:
            self._status_stale = True
        return changed

    def status(self) -> ViewStatus:
        """Return the state to show; the same object while nothing changed."""
        now = wall_clock.monotonic()
        if self._status_stale and now - self._status_made >= STATUS_PERIOD_S:
            self._status_stale = False
            self._status_made = now
            made = self._make_status()
            if made != self._status:
                self._status = made
        return self._status

    def fresh_status(self) -> ViewStatus:
        """Return the state as it is this very moment."""
        self._status_made = -math.inf
        self._status_stale = True
        return self.status()

    def close(self) -> None:
        """End the network and the decoding. May be called twice."""
        self.desk.close()
        self.loader.close()

    # --- the picture ----------------------------------------------------------------------------------

    @property
    def heightfield(self) -> Heightfield | None:
        """The ground, None before the terrain has come."""
        return None if self.shown is None else self.shown.heightfield

    def frame_inputs(self) -> FrameInputs | None:
        """Return all the picture depends on, None before the terrain has come."""
        if self.shown is None or self.camera_work is None:
            return None
        notice = "" if self.desk.is_open else self.desk.connection_sentence()
        progress = self.desk.book.progress.get(self.shown.run)
        return FrameInputs(
            camera=self.camera_work.camera,
            water=self.feed.pair,
            edits=edit_overlay(self.shown, self.editing.drawing),
            options=self.options,
            hud=hud_text(self.shown, self.clock.time, progress, self.recalculated, notice),
        )

    def note_painted(self, size: tuple[int, int]) -> None:
        """The inputs given last are on the picture; the latency of a recalculation ends here."""
        if self.camera_work is not None:
            self.camera_work.aspect = size[0] / size[1]
        if self.recalculated is not None and self.feed.keys is not None and self.feed.pair is not None:
            keys = self.feed.keys if self.feed.pair.alpha > 0.0 else self.feed.keys[:1]
            if self.recalculated.note_painted(keys, wall_clock.monotonic()):
                self._status_stale = True
                if self.recalculated.next_frame_s is None:
                    self.say(f"recalculated: first frame after {self.recalculated.first_frame_s:.2f} s")

    def take_picture_path(self) -> str | None:
        """Return where the next picture is to be written, once."""
        path, self._picture_path = self._picture_path, None
        return path

    @property
    def is_settled(self) -> bool:
        """Whether water and camera stand where the playback time and the commands want them."""
        shown = self.shown
        if shown is None or self.camera_work is None or self.camera_work.is_moving or self._is_held:
            return False
        keys, alpha = self.feed.wanted(shown, self.clock.time)
        if not keys:
            return False
        return (
            self.feed.pair is not None
            and self.feed.keys == (keys[0], keys[1])
            and self.feed.pair.alpha == alpha
        )

    @property
    def is_busy(self) -> bool:
        """Whether an edit or a recalculation waits for the service."""
        begun = self.recalculated
        return self.editing.unconfirmed is not None or (begun is not None and begun.is_waiting)

    # --- within ---------------------------------------------------------------------------------------

    @property
    def _is_held(self) -> bool:
        """Whether the picture waits for the first frame of a branch rather than step back by one."""
        shown = self.shown
        return (
            shown is not None
            and shown.branch_index > 0
            and self.clock.time >= shown.branch_index * shown.info.output_interval
            and shown.branch_index not in shown.timeline
        )

    def _forget_recalculate(self) -> None:
        self._recalculate_wanted = False

    def _require_run(self) -> ShownRun:
        if self.shown is None:
            raise CommandError("no run is shown yet")
        return self.shown

    def _request_frame(self, index: int) -> None:
        if self.shown is not None and self.desk.is_open:
            self.desk.seek(self.shown.run, index)

    def _take_frame(self, frame: protocol.Frame) -> None:
        gone = self.loader.store(frame)
        self.desk.book.note_frame_count(frame.run, frame.index)
        shown = self.shown
        if shown is None or gone is None:
            return
        if frame.run == shown.run:
            shown.info = self.desk.book.runs[shown.run]
        if shown.note_frame((frame.run, frame.index)):
            self._status_stale = True
        shown.discard_frames(frame.run, gone)
        self.desk.connection.resume_point = protocol.ResumePoint(
            shown.run, frame.index, shown.document.revision
        )

    def _advance_clock(self, shown: ShownRun, wall_dt: float) -> bool:
        before = self.clock.time
        at_hand = max(shown.timeline.last_time, shown.branch_index * shown.info.output_interval)
        last = at_hand if before <= at_hand and self.clock.is_playing else shown.computed_until
        return (
            self.clock.advance(wall_dt, 0.0, max(last, before if not self.clock.is_playing else last))
            != before
        )

    def _show(self, info: protocol.RunInfo) -> None:
        """Show a run: at once when its terrain is at hand, else when it has come."""
        before = self.shown
        for entry in info.lineage or (protocol.LineageEntry(info.run, 0),):
            self.loader.add_run(entry.run, info.grid.nrows, info.grid.ncols)
        root = (info.lineage[0].run if info.lineage else info.run) if info.parent is not None else info.run
        if before is None or before.root != root:
            self.desk.fetch_terrain(info.run)
            return
        self._enter(
            ShownRun(info, before.document.base, self.loader, before.heightfield), is_other_terrain=False
        )

    def _enter(self, shown: ShownRun, *, is_other_terrain: bool) -> None:
        """Make `shown` the run on the picture."""
        self.shown = shown
        self.editing.reset()
        if is_other_terrain:
            self.feed.forget()
        begun = self.recalculated
        is_answer = begun is not None and begun.child == shown.run
        working = self.desk.book.working_lists.get(shown.run)
        if working is not None:
            shown.document.mirror(working.revision, working.edits, working.can_undo, working.can_redo)
        elif is_answer and begun is not None:
            shown.document.mirror(shown.info.revision, begun.edits, bool(begun.edits), False)
        if is_answer and begun is not None:
            self.clock.seek(begun.index * shown.info.output_interval)
            if begun.follows_live:
                self.clock.follow_live()
        else:
            self._subscribe(shown)
        self.message = ""
        self._picture_stale = self._status_stale = True

    def _subscribe(self, shown: ShownRun) -> None:
        self.desk.subscribe(shown.run, shown.next_missing(), "replay")

    def _make_status(self) -> ViewStatus:
        status = program_status(self.desk, self.clock, self.editing.drawing, self.message)
        if self.shown is None:
            return status
        return dataclasses.replace(
            run_status(status, self.shown, self.desk, self.recalculated),
            hover=point_readout(self.shown, self.feed, self._hover_at),
            probe=point_readout(self.shown, self.feed, self._probe_at),
        )
