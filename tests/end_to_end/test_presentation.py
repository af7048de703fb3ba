"""One shows where the water goes, the others follow."""

import dataclasses
import time
from collections.abc import Callable

import pytest

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from tests.end_to_end.test_controllers import session_of, start_paused
from viewer.app.viewer_app import ViewerApp
from viewer.commands import FlyTo, FollowView, PresentView, StartRun
from viewer.net import ConnectionThread, FrameLoader


class Viewer:
    """The program behind a window, without one."""

    def __init__(self, service: ServiceProcess) -> None:
        connection = ConnectionThread(service.url, service.token)
        self.app = ViewerApp(connection, FrameLoader())
        connection.start()

    def __enter__(self) -> "Viewer":
        self.until(lambda: bool(self.app.desk.book.cases))
        return self

    def __exit__(self, *_: object) -> None:
        self.app.close()

    def advance(self) -> None:
        if self.app.advance(time.monotonic()) and self.app.frame_inputs() is not None:
            self.app.note_painted((64, 36))

    def until(self, condition: Callable[[], bool], timeout_s: float = 30.0) -> None:
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, f"waited in vain; the viewer says {self.app.message!r}"
            self.advance()
            time.sleep(0.005)


def test_a_presented_view_reaches_all_others_also_those_who_come_later_and_ends_with_its_session(
    service: ServiceProcess, client: ServiceClient, case: str
) -> None:
    run = start_paused(client, case)
    view = protocol.View(run, 0.0, 10.0, 20.0, 300.0, 45.0, 30.0)
    with ServiceClient(service) as presenter:
        assert (
            "there is no run"
            in presenter.ask(
                protocol.PresentView, view=protocol.View("no-run", 0.0, 1.0, 1.0, 1.0, 0.0, 0.0)
            ).message
        )
        presenter.do(protocol.PresentView, view=view)
        told = client.first(protocol.ViewPresented)
        assert (told.session, told.view) == (session_of(presenter), view)
        with ServiceClient(service) as late:
            assert late.first(protocol.ViewPresented).view == view
    assert client.first(protocol.ViewPresented, lambda event: event.view is None).session == told.session


def test_a_viewer_that_follows_sees_what_the_presenting_one_sees(service: ServiceProcess, case: str) -> None:
    with Viewer(service) as presenter, Viewer(service) as follower:
        presenter.app.carry_out(StartRun(case, 20.0))
        presenter.until(lambda: presenter.app.is_settled and presenter.app.shown is not None)
        presenter.app.carry_out(FlyTo(300.0, 200.0, 500.0, 75.0, 35.0, seconds=0.0))
        presenter.app.carry_out(PresentView())

        ours = presenter.app.desk.session

        def is_offered() -> bool:
            presenter.advance()
            return ours in [row.session for row in follower.app.fresh_status().presenters]

        follower.until(is_offered)
        follower.app.carry_out(FollowView(ours))
        pose = presenter.app.view_pose()
        assert pose is not None

        def is_there() -> bool:
            theirs = follower.app.view_pose()
            return theirs is not None and dataclasses.astuple(theirs) == pytest.approx(
                dataclasses.astuple(pose), abs=0.5
            )

        follower.until(is_there)

        assert follower.app.shown is not None
        assert presenter.app.shown is not None
        assert follower.app.shown.run == presenter.app.shown.run
