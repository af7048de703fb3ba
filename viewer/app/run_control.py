"""Which run is on the picture: starting, choosing, recalculating, and what the service says of it."""

from __future__ import annotations

import time as wall_clock
from collections.abc import Callable, Mapping
from pathlib import Path

import protocol
from viewer.app.editing import Editing
from viewer.app.endpoint import read_token, stream_url
from viewer.app.forcing_work import ForcingWork
from viewer.app.recalculation import Recalculation
from viewer.app.run_steering import RunSteering
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.app.terrain_pictures import TerrainPictures
from viewer.commands import (
    Command,
    CommandError,
    ConnectTo,
    Recalculate,
    Reconnect,
    SelectRun,
    StartRun,
)
from viewer.errors import TerrainDataError
from viewer.net import ConnectionThread, FrameLoader
from viewer.world import PlaybackClock

__all__ = ["RunControl"]


class RunControl:
    """Keeps the shown run in step with the service and with what the user asks for.

    Args:
        connection: the connection to the service.
        loader: where frames go.
        clock: the playback clock; a new run is followed live, a branch begins where it left its parent.
        new_terrain: called when another terrain has come to be shown.
        autostart: run to start once the connection stands, None to start nothing.

    Attributes:
        desk: the dealings with the service.
        editing: the edit tool.
        steering: pauses, ends, names, keeps runs, and their control.
        forcing: the working forcing.
        shown: the run on the picture, None before the first terrain has come.
        recalculated: the newest recalculation asked for.
        message: the newest sentence for the user.
        presented: called with what another session shows of its view.
        opened: called when a connection stands.
        is_stale: whether anything changed since somebody last looked; set True here, False by who looks.
    """

    def __init__(
        self,
        connection: ConnectionThread,
        loader: FrameLoader,
        clock: PlaybackClock,
        new_terrain: Callable[[ShownRun], None],
        autostart: StartRun | None = None,
    ) -> None:
        self.desk = ServiceDesk(connection, self)
        self.editing = Editing(self.desk, self.say)
        self.editing.list.settled = self._edits_settled
        self.steering = RunSteering(self.desk, lambda: self.require_run().run)
        self.forcing = ForcingWork(self.desk)
        self.shown: ShownRun | None = None
        self.recalculated: Recalculation | None = None
        self.message = ""
        self.presented: Callable[[protocol.ViewPresented], None] = lambda message: None
        self.opened: Callable[[], None] = lambda: None
        self.is_stale = True
        self._loader = loader
        self._clock = clock
        self._new_terrain = new_terrain
        self._autostart = autostart
        self._awaited_run: str | None = None
        self._pictures = TerrainPictures("")
        self._recalculate_wanted = False

    # --- what the user asks for -----------------------------------------------------------------------

    def carry_out(self, command: Command) -> bool:
        """Carry out a command about runs; return False when it is none.

        Raises:
            CommandError: it makes no sense now.
        """
        match command:
            case ConnectTo(url, token_file):
                self._connect_to(url, token_file)
            case Reconnect():
                self.desk.connection.retry()
            case StartRun():
                self.start_run(command)
            case SelectRun(run):
                self.select_run(run)
            case Recalculate():
                self.recalculate()
            case _:
                return self.steering.carry_out(command) or self.forcing.carry_out(command, self.shown)
        return True

    def start_run(self, command: StartRun) -> None:
        """Ask for a new run; it is shown and followed live as soon as it exists."""

        def started(result: Mapping[str, object]) -> None:
            self._awaited_run = str(result["run"])
            self._clock.seek(0.0)
            self._clock.follow_live()
            info = self.desk.book.runs.get(self._awaited_run)
            if info is not None:
                self.run_changed(info)

        forcing = self.forcing.for_start(command.case, self.shown) if command.with_forcing else ()
        self.say(f"starting {command.case} ...")
        self.desk.start_run(
            command.case,
            command.duration,
            command.output_interval,
            command.device,
            forcing,
            started,
            lambda _reason: None,
        )

    def select_run(self, run: str) -> None:
        """Show another run.

        Raises:
            CommandError: it is unknown.
        """
        info = self.desk.book.runs.get(run)
        if info is None:
            raise CommandError(f"run {run!r} is unknown")
        self._awaited_run = run
        self.run_changed(info)

    def recalculate(self) -> None:
        """Branch the shown run at the frame at or before the playback time, with the working list of edits.

        An edit that the service has not confirmed yet is waited for.

        Raises:
            CommandError: there is nothing to recalculate, or it is being done already.
        """
        shown = self.require_run()
        if self.recalculated is not None and self.recalculated.is_waiting:
            raise CommandError("a recalculation is under way already")
        if shown.info.frame_count == 0 and len(shown.timeline) == 0:
            raise CommandError("there is no computed frame to recalculate from yet")
        if self.editing.list.is_waiting(shown):
            self._recalculate_wanted = True
            return
        self._recalculate_wanted = False
        newest = max(shown.info.frame_count - 1, shown.timeline.index_before(shown.timeline.last_time))
        index = min(shown.timeline.index_before(self._clock.time), newest)
        document = shown.document
        begun = Recalculation(
            shown.run, index, document.edits, wall_clock.monotonic(), self._clock.follows_live
        )
        self.recalculated = begun

        def done(result: Mapping[str, object]) -> None:
            begun.child = str(result["run"])
            self.desk.book.applied[begun.child] = begun.edits
            self._awaited_run = begun.child
            info = self.desk.book.runs.get(begun.child)
            if info is not None:
                self.run_changed(info)

        def refused(_reason: str) -> None:
            self.recalculated = None

        forcing_revision = self.forcing.revision(shown.run)
        self.desk.recalculate(shown.run, index, document.revision, forcing_revision, done, refused)
        self.say("recalculating ...")

    def require_run(self) -> ShownRun:
        """Return the shown run.

        Raises:
            CommandError: there is none.
        """
        if self.shown is None:
            raise CommandError("no run is shown yet")
        return self.shown

    def request_frame(self, index: int) -> None:
        """Ask for a frame of the shown run that is not at hand."""
        if self.shown is not None and self.desk.is_open:
            self.desk.seek(self.shown.run, index)

    def resubscribe(self) -> None:
        """Let the stream serve the shown run."""
        if self.shown is not None:
            self._subscribe(self.shown)

    # --- what the service says ----------------------------------------------------------------------

    def connection_opened(self) -> None:
        """Take up where the lost connection was, or start what was asked for at the beginning."""
        self.is_stale = True
        self.message = ""
        self.opened()
        if self.shown is not None:
            self._subscribe(self.shown)
        elif self._autostart is not None:
            command, self._autostart = self._autostart, None
            self.start_run(command)

    def run_changed(self, info: protocol.RunInfo) -> None:
        """Follow a change of the shown run; show the run that is waited for."""
        self.is_stale = True
        if self.shown is not None and info.run == self.shown.run:
            self.shown.info = info
        if info.run == self._awaited_run and (self.shown is None or info.run != self.shown.run):
            self._show(info)

    def edits_changed(self, message: protocol.EditsChanged) -> None:
        """Take over the working list of the shown run."""
        self.is_stale = True
        shown = self.shown
        if shown is None or message.run != shown.run:
            return
        self.editing.note_edits(message, shown)

    def view_presented(self, message: protocol.ViewPresented) -> None:
        """Another session shows its view, or no longer."""
        self.presented(message)

    def terrain_came(self, message: protocol.TerrainReceived) -> None:
        """Show the run whose terrain was waited for."""
        info = self.desk.book.runs.get(message.run)
        if info is None or message.run != self._awaited_run:
            return
        shown = ShownRun(info, message.z_b, self._loader)
        if self._pictures.run == message.run:
            self._pictures.lay_on(shown.heightfield)
        self._enter(shown)
        assert self.shown is not None
        self._new_terrain(self.shown)

    def picture_came(self, message: protocol.ImageryReceived) -> None:
        """Lay a picture on the terrain that it belongs to."""
        info = self.desk.book.runs.get(message.run)
        if info is None or message.run != self._pictures.run:
            return
        try:
            self._pictures.take(message, (info.grid.nrows, info.grid.ncols))
        except TerrainDataError as error:
            self.say(str(error))

    def say(self, sentence: str) -> None:
        """Show a sentence in the status line."""
        self.message = sentence
        self.is_stale = True

    def take_frame(self, frame: protocol.Frame) -> None:
        """Keep a frame that came in."""
        gone = self._loader.store(frame)
        self.desk.book.note_frame_count(frame.run, frame.index)
        shown = self.shown
        if shown is None or gone is None:
            return
        if frame.run == shown.run:
            shown.info = self.desk.book.runs[shown.run]
        is_ours = shown.note_frame((frame.run, frame.index))
        shown.discard_frames(frame.run, gone)
        if not is_ours:
            return  # of a run that it is compared with
        self.is_stale = True
        self.desk.connection.resume_point = protocol.ResumePoint(
            shown.run, frame.index, shown.document.revision
        )

    @property
    def is_held(self) -> bool:
        """Whether the picture waits for the first frame of a branch rather than step back by one."""
        shown = self.shown
        return (
            shown is not None
            and shown.branch_index > 0
            and self._clock.time >= shown.branch_index * shown.info.output_interval
            and shown.branch_index not in shown.timeline
        )

    def _connect_to(self, url: str, token_file: str | None) -> None:
        address = stream_url(url)
        token = read_token(None if token_file is None else Path(token_file))
        self.desk.change_service(address, token)
        self.editing.reset()
        self.shown = self.recalculated = self._awaited_run = self._autostart = None
        self._recalculate_wanted = False
        self._clock.seek(0.0)
        self.say(f"connecting to {address}")

    # --- within ---------------------------------------------------------------------------------------

    def _edits_settled(self, is_taken: bool) -> None:
        """No edit waits any more: a recalculation that waited for them can begin, if they were taken."""
        wanted, self._recalculate_wanted = self._recalculate_wanted, False
        if wanted and is_taken:
            try:
                self.recalculate()
            except CommandError as error:
                self.say(str(error))

    def _show(self, info: protocol.RunInfo) -> None:
        """Show a run: at once when its terrain is at hand, else when it has come."""
        before = self.shown
        for entry in info.lineage or (protocol.LineageEntry(info.run, 0),):
            self._loader.add_run(entry.run, info.grid.nrows, info.grid.ncols)
        root = (info.lineage[0].run if info.lineage else info.run) if info.parent is not None else info.run
        if before is None or before.root != root:
            self._pictures = TerrainPictures(info.run)
            self.desk.fetch_terrain(info)
            return
        self._enter(ShownRun(info, before.document.base, self._loader, before.heightfield))

    def _enter(self, shown: ShownRun) -> None:
        """Make `shown` the run on the picture."""
        self.shown = shown
        self.editing.reset()
        begun = self.recalculated
        is_answer = begun is not None and begun.child == shown.run
        working = self.desk.book.working_lists.get(shown.run)
        if working is not None:
            self.editing.list.note(working, shown)
        elif is_answer and begun is not None:
            shown.document.mirror(shown.info.revision, begun.edits, bool(begun.edits), False)
        if is_answer and begun is not None:
            self._clock.seek(begun.index * shown.info.output_interval)
            if begun.follows_live:
                self._clock.follow_live()
        else:
            self._subscribe(shown)
        self.message = ""
        self.is_stale = True

    def _subscribe(self, shown: ShownRun) -> None:
        self.desk.subscribe(shown.run, shown.next_missing(), "replay")
