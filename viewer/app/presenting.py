"""Showing one's view to the others, and following somebody who shows theirs."""

from __future__ import annotations

import dataclasses

import protocol
from viewer.app.camera_work import CameraWork
from viewer.app.run_control import RunControl
from viewer.commands import (
    Command,
    CommandError,
    DragOrbit,
    DragPan,
    FlyTo,
    FollowView,
    HoldMove,
    PresentView,
    ResetView,
    Seek,
    SelectRun,
    TopView,
    Zoom,
)
from viewer.view_status import PresenterRow, ViewStatus
from viewer.world import PlaybackClock

__all__ = ["Presenting"]

PERIOD_S = 0.2
"""Between two views that are sent [s]; the camera of a follower glides over it."""
DRIFT_S = 1.0
"""Playback of a follower may be this far from the presenter's, in seconds of wall time."""
LEAVING = (DragOrbit, DragPan, Zoom, HoldMove, ResetView, TopView, FlyTo, Seek, SelectRun)
"""Commands by which a follower goes a way of their own."""


class Presenting:
    """What this viewer presents and whom it follows.

    Args:
        control: the shown run and the dealings with the service.
        clock: the playback clock.

    Attributes:
        is_presenting: whether the others are shown this view.
        following: session whose view is followed; None flies freely.
    """

    def __init__(self, control: RunControl, clock: PlaybackClock) -> None:
        self._control = control
        self._clock = clock
        self.is_presenting = False
        self.following: str | None = None
        self._views: dict[str, protocol.ViewPresented] = {}
        self._sent: protocol.View | None = None
        self._sent_at = float("-inf")
        self._followed: protocol.View | None = None
        self._asked: str | None = None

    def report(self, status: ViewStatus) -> ViewStatus:
        """Return `status` with who presents and who is followed."""
        rows = tuple(PresenterRow(name, shown.client) for name, shown in self._views.items())
        return dataclasses.replace(
            status, presenters=rows, is_presenting=self.is_presenting, followed=self.following
        )

    def carry_out(self, command: Command) -> bool:
        """Carry out a command about presentations; return False when it is none.

        Raises:
            CommandError: the session to follow does not present.
        """
        match command:
            case PresentView(on):
                self._present(on)
            case FollowView(session):
                if session is not None and session not in self._views:
                    raise CommandError(f"session {session!r} presents no view; {self._named()}")
                self.following, self._followed, self._asked = session, None, None
                if session is not None:
                    self._present(False)
            case _:
                if isinstance(command, LEAVING):
                    self.following = None
                return False
        return True

    def take(self, message: protocol.ViewPresented) -> None:
        """Note what a session shows."""
        if message.view is not None:
            self._views[message.session] = message
            return
        self._views.pop(message.session, None)
        if self.following == message.session:
            self.following = None
            self._control.say("the presentation is over; the view is yours again")

    def forget(self) -> None:
        """Another connection begins: who presents will be told anew."""
        self._views.clear()
        self._sent = self._asked = None

    def advance(self, camera: CameraWork | None, now: float) -> None:
        """Show what has changed, or fly where the presenter is.

        Args:
            camera: the camera of the picture, None before a terrain is shown.
            now: wall time [s, monotonic].
        """
        if self.is_presenting and camera is not None:
            self._show(camera, now)
        shown = None if self.following is None else self._views.get(self.following)
        if shown is not None and shown.view is not None and shown.view is not self._followed:
            self._fly_along(camera, shown.view)

    def _present(self, on: bool) -> None:
        if self.is_presenting and not on:
            self._control.desk.present_view(None)
        self.is_presenting = on
        if on:
            self.following = None
        self._sent = None

    def _show(self, camera: CameraWork, now: float) -> None:
        view = self._view(camera)
        if view is None or view == self._sent or now - self._sent_at < PERIOD_S:
            return
        if self._control.desk.is_open:
            self._control.desk.present_view(view)
            self._sent, self._sent_at = view, now

    def _view(self, camera: CameraWork) -> protocol.View | None:
        shown = self._control.shown
        if shown is None:
            return None
        pose = camera.pose()
        assert pose.distance is not None
        assert pose.azimuth is not None
        assert pose.elevation is not None
        return protocol.View(
            shown.run,
            max(0.0, self._clock.time),
            pose.x,
            pose.y,
            pose.distance,
            pose.azimuth,
            pose.elevation,
            self._clock.is_playing,
            self._clock.speed,
        )

    def _fly_along(self, camera: CameraWork | None, view: protocol.View) -> None:
        shown = self._control.shown
        if shown is None or camera is None or shown.run != view.run:
            if self._asked != view.run and view.run in self._control.desk.book.runs:
                self._asked = view.run
                self._control.carry_out(SelectRun(view.run))
            return  # its terrain may have to come first; the view is taken up once it is shown
        self._asked = None
        self._followed = view
        camera.carry_out(FlyTo(view.x, view.y, view.distance, view.azimuth, view.elevation, PERIOD_S))
        self._clock.set_speed(view.speed)
        drift = DRIFT_S * view.speed if view.is_playing else 0.0
        if abs(self._clock.time - view.time) > drift:
            self._clock.seek(view.time)
        if view.is_playing != self._clock.is_playing:
            self._clock.play() if view.is_playing else self._clock.pause()

    def _named(self) -> str:
        return f"presenting are {', '.join(self._views)}" if self._views else "nobody does"
