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
from viewer.app.channel_feed import ChannelFeed
from viewer.app.comparison import Comparison
from viewer.app.edit_report import edit_overlay
from viewer.app.flow_probe import FlowProbe
from viewer.app.gauges import Gauges
from viewer.app.hud_writer import HudWriter
from viewer.app.levee_watch import LeveeWatch
from viewer.app.map_maker import MapMaker
from viewer.app.measuring import Measuring
from viewer.app.picture_file import checked_order
from viewer.app.playback import Playback
from viewer.app.pointing import Pointing
from viewer.app.presenting import Presenting
from viewer.app.recalculation import Recalculation
from viewer.app.run_control import RunControl
from viewer.app.series_feed import SeriesFeed
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.app.status_report import program_status, run_status
from viewer.app.traffic import Traffic
from viewer.app.view_options import changed_options, option_values
from viewer.app.water_feed import WaterFeed
from viewer.app.water_view import WaterView
from viewer.commands import (
    CancelEdit,
    Command,
    CommandError,
    FlyTo,
    FollowLive,
    MoveHover,
    Pause,
    PauseRun,
    Play,
    ProbeAt,
    Recalculate,
    Redo,
    ResumeRun,
    SavePicture,
    SetOption,
    SetSpeed,
    ShowSeries,
    StartRun,
    StopRun,
    TogglePlay,
    Undo,
)
from viewer.errors import ViewerError
from viewer.net import ChannelLoader, ConnectionThread, FrameLoader
from viewer.render import EditOverlay, FrameInputs, RenderOptions
from viewer.view_status import ViewStatus
from viewer.world import Heightfield, MapView, PlaybackClock

__all__ = ["ViewerApp"]

WITHOUT_PICTURE = (
    FollowLive,
    MoveHover,
    Pause,
    PauseRun,
    Play,
    ProbeAt,
    Recalculate,
    Redo,
    ResumeRun,
    SetSpeed,
    StartRun,
    StopRun,
    TogglePlay,
    Undo,
)
"""Commands that change no picture by themselves; what they bring about does."""
CLICK_REACH = 0.015
"""How far a click may miss what it is meant for, as a share of the height of the picture."""
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
        self.loader = loader
        self.clock = PlaybackClock()
        self.control = RunControl(connection, loader, self.clock, self._new_terrain, autostart)
        self.playback = Playback(self.clock, self.control.require_run)
        self.feed = WaterFeed(loader, self.desk.book, self.control.request_frame)
        channels = ChannelFeed(self.desk, ChannelLoader())
        self.pointing = Pointing(loader, self.feed, FlowProbe(channels, self.feed))
        self.gauges = Gauges(self.desk.book, SeriesFeed(self.desk, self.complain), self.pointing)
        self.options = RenderOptions()
        self.camera_work: CameraWork | None = None
        self._picture_order: SavePicture | None = None
        self._last_advance: float | None = None
        self._picture_stale = True
        self._status_stale = True
        self._status_made = -math.inf
        self._status = ViewStatus()
        self._map_maker = MapMaker()
        self._traffic = Traffic()
        self._levee_watch = LeveeWatch()
        self.water = WaterView(self.feed, channels)
        self.comparison = Comparison(self.desk, loader, self.feed, channels, self.control.resubscribe)
        self.control.steering.resuming = self.comparison.return_stream
        self.control.editing.reach = self._click_reach
        self.control.editing.look = lambda x, y: self.pointing.readout(x, y, self.shown)
        self.presenting = Presenting(self.control, self.clock)
        self.measuring = Measuring()
        self._hud = HudWriter(self.control, self.clock, self.measuring)
        self.control.presented = self.presenting.take
        self.control.opened = self.presenting.forget

    @property
    def desk(self) -> ServiceDesk:
        """The dealings with the service."""
        return self.control.desk

    @property
    def shown(self) -> ShownRun | None:
        """The run on the picture, None before the first terrain has come."""
        return self.control.shown

    @property
    def recalculated(self) -> Recalculation | None:
        """The newest recalculation asked for."""
        return self.control.recalculated

    @property
    def message(self) -> str:
        """The newest sentence for the user."""
        return self.control.message

    # --- commands ---------------------------------------------------------------------------------

    def dispatch(self, command: Command) -> None:
        """Carry out a command; what goes wrong is told in the status message."""
        self._status_stale = True
        try:
            self.carry_out(command)
        except (ViewerError, protocol.ProtocolError) as error:
            self.complain(str(error))

    def carry_out(self, command: Command) -> None:
        """Carry out a command.

        Raises:
            CommandError: it makes no sense now; nothing was changed.
        """
        self._picture_stale |= not isinstance(command, WITHOUT_PICTURE)
        if (
            self.presenting.carry_out(command)
            or self.playback.carry_out(command)
            or self._steer(command)
            or self._measure(command)
            or self.comparison.carry_out(command, self.shown)
            or self._edit(command)
        ):
            return
        match command:
            case SetOption(name, value):
                self.options = changed_options(self.options, name, value)
                if self.camera_work is not None:
                    self.camera_work.set_exaggeration(self.options.exaggeration)
            case ProbeAt() | ShowSeries():
                self._picture_stale |= self.gauges.take(command, self.shown, self.camera_work, self.options)
            case MoveHover():
                self.pointing.take(command, self.shown)
                self._picture_stale |= self.control.editing.drawing.is_on or self.measuring.is_on
                self.control.editing.hover(self.pointing.hover_at, self.shown)
                self.measuring.hover = self.pointing.hover_at
            case SavePicture():
                self._picture_order = checked_order(command)
            case _:
                if self.camera_work is None or not self.camera_work.carry_out(command):
                    raise CommandError(f"{type(command).__name__} is not possible before a terrain is shown")

    def _steer(self, command: Command) -> bool:
        is_done = self.control.carry_out(command)
        if self.shown is None and self.camera_work is not None:  # another service
            self.comparison.end()
            self.camera_work = None
            self.feed.forget()
        return is_done

    def _edit(self, command: Command) -> bool:
        is_done = self.control.editing.carry_out(command, self.shown)
        if is_done and self.control.editing.tool and self.measuring.is_on:
            self.measuring.put_away()  # one tool in the hand
        return is_done

    def _measure(self, command: Command) -> bool:
        is_done = self.measuring.carry_out(command, self.shown)
        if is_done and self.measuring.is_on and self.control.editing.tool:
            self.control.editing.carry_out(CancelEdit(), self.shown)  # one tool in the hand
        return is_done

    # --- time ---------------------------------------------------------------------------------------

    def advance(self, now: float) -> bool:
        """Move on to wall time `now` [s, monotonic]; return whether the picture has changed."""
        wall_dt = 0.0 if self._last_advance is None else max(0.0, now - self._last_advance)
        self._last_advance = now
        connected_before = self._status.is_connected
        for frame in self.desk.drain():
            self.control.take_frame(frame)
            self.comparison.take_frame(frame)
        if self.desk.is_open != connected_before or not self.desk.is_open:
            self._status_stale = True
        self._picture_stale |= self.desk.is_open != connected_before
        self._status_stale |= self.control.is_stale
        self.control.is_stale = False
        changed = self._picture_stale
        # Never before a branch: its first frame is not to wait for a picture of its parent.
        if self.shown is not None and not self.is_busy:
            changed |= self._hud.is_old(self.shown, self.options, now)
        self._picture_stale = False
        self.presenting.advance(self.camera_work, now)
        shown = self.shown
        if shown is not None and self.camera_work is not None:
            changed |= self.camera_work.advance(wall_dt)
            changed |= self.playback.advance(shown, wall_dt)
            if not self.control.is_held:
                changed |= self.feed.advance(shown, self.clock.time)
            changed |= shown.refresh_ground(self.feed.moved)
            changed |= self.comparison.advance(shown, self.clock.time, self.options)
            changed |= self.water.advance(shown, self.options)
            self.gauges.advance(shown, self.comparison.other, now)
            self._status_stale |= self._levee_watch.look(shown, self.feed, self.options.depth_shown)
        if changed:
            self._status_stale = True
        return changed

    def status(self) -> ViewStatus:
        """Return the state to show; the same object while nothing changed."""
        now = wall_clock.monotonic()
        if self._status_stale and now - self._status_made >= STATUS_PERIOD_S:
            self._status_stale = False
            self._status_made = now
            self.pointing.trace(self.shown, self.comparison.other)
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
        self.water.close()

    def complain(self, sentence: str) -> None:
        """Show a sentence in the status line."""
        self.control.say(sentence)

    # --- the picture ----------------------------------------------------------------------------------

    @property
    def heightfield(self) -> Heightfield | None:
        """The ground, None before the terrain has come."""
        return None if self.shown is None else self.shown.heightfield

    def view_pose(self) -> FlyTo | None:
        """Return the command that brings back the present view; None without terrain."""
        return None if self.camera_work is None else self.camera_work.pose()

    def map_view(self) -> MapView | None:
        """Return the reference map, the same object while nothing on it has changed; None without terrain."""
        if self.shown is None or self.camera_work is None:
            return None
        now, depth_shown = wall_clock.monotonic(), self.options.depth_shown
        return self._map_maker.map_view(self.shown, self.camera_work, self.feed, depth_shown, now)

    def frame_inputs(self) -> FrameInputs | None:
        """Return all the picture depends on, None before the terrain has come."""
        if self.shown is None or self.camera_work is None:
            return None
        inputs = FrameInputs(
            camera=self.camera_work.camera,
            water=self.feed.pair,
            edits=self.measuring.overlay(self._marks(self.shown), self.shown),
            options=self.options,
            hud=self._hud.write(self.shown, self.options),
            is_outdated=not self.desk.is_open,
        )
        inputs = self.gauges.dressed(self.water.dressed(inputs), self.shown)
        return self.comparison.dressed(inputs, self.shown)

    def note_painted(self, size: tuple[int, int]) -> None:
        """The inputs given last are on the picture; the latency of a recalculation ends here."""
        if self.camera_work is not None:
            self.camera_work.set_aspect(size[0] / size[1])
        if self.recalculated is not None and self.feed.keys is not None and self.feed.pair is not None:
            keys = self.feed.keys if self.feed.pair.alpha > 0.0 else self.feed.keys[:1]
            if self.recalculated.note_painted(keys, wall_clock.monotonic()):
                self._status_stale = True
                if self.recalculated.next_frame_s is None:
                    self.complain(f"recalculated: first frame after {self.recalculated.first_frame_s:.2f} s")

    def take_picture_order(self) -> SavePicture | None:
        """Return how and where the picture is to be written, once."""
        order, self._picture_order = self._picture_order, None
        return order

    @property
    def is_settled(self) -> bool:
        """Whether water and camera stand where the playback time and the commands want them."""
        shown = self.shown
        if shown is None or self.camera_work is None or self.camera_work.is_moving or self.control.is_held:
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
        return self.control.editing.list.is_waiting(self.shown) or (begun is not None and begun.is_waiting)

    # --- within ---------------------------------------------------------------------------------------

    def _marks(self, shown: ShownRun) -> EditOverlay | None:
        return edit_overlay(shown, self.control.editing) if self.options.show_edits else None

    def _click_reach(self) -> float:
        """How far on the ground looked at a click may miss [m]."""
        if self.camera_work is None:
            return 0.0
        camera = self.camera_work.camera
        return CLICK_REACH * 2.0 * camera.distance * math.tan(0.5 * camera.fov_y)

    def _new_terrain(self, shown: ShownRun) -> None:
        """Look at another terrain from where all of it is seen."""
        aspect = 16.0 / 9.0 if self.camera_work is None else self.camera_work.aspect
        self.camera_work = CameraWork(shown.heightfield, self.options.exaggeration, aspect)
        self.feed.forget()
        self.playback.fit_speed(shown.info.duration)

    def _make_status(self) -> ViewStatus:
        status = program_status(self.desk, self.clock, self.control.editing, self.message)
        now = wall_clock.monotonic()
        status = self._traffic.report(status, self.desk, now)
        status = self.presenting.report(status)
        status = dataclasses.replace(
            status,
            units=self.options.units,
            options=option_values(self.options),
            loops=self.clock.loops,
        )
        if self.shown is None:
            return status
        status = run_status(
            status, self.shown, self.desk, self.recalculated, self._levee_watch, self.control.forcing
        )
        status = self.water.told(status, self.shown, self.options)
        compared = self.comparison.told(status)
        measured = self.measuring.report(compared, self.shown)
        pointed = self.pointing.report(measured, self.shown, self.comparison.other)
        return self.gauges.report(pointed, self.shown, self.comparison.other)
