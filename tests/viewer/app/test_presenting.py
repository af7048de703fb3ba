import time

import pytest

import protocol
from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import INTERVAL
from viewer.app.presenting import PERIOD_S
from viewer.commands import (
    CommandError,
    DragOrbit,
    FlyTo,
    FollowView,
    Pause,
    PresentView,
    Seek,
)
from viewer.view_status import PresenterRow


def shown_by(flight: Flight, run: str | None = None, playing: bool = False) -> protocol.ViewPresented:
    view = protocol.View(
        run or flight.shown.run, 5.0 * INTERVAL, 1300.0, 2400.0, 700.0, 30.0, 50.0, playing, 20.0
    )
    return protocol.ViewPresented("anna", "fev-viewer", view)


def where(flight: Flight) -> tuple[int, int, int]:
    pose = flight.app.view_pose()
    assert pose is not None
    return round(pose.x), round(pose.y), round(pose.distance or 0.0)


def test_a_presenter_sends_what_changes_and_nothing_else(flight: Flight) -> None:
    flight.do(
        Pause(), Seek(3.0 * INTERVAL), FlyTo(1250.0, 2380.0, 600.0, 10.0, 40.0, seconds=0.0), PresentView()
    )
    flight.until(lambda: len(flight.service.presented) == 1)
    end = time.monotonic() + 2.0 * PERIOD_S
    flight.until(lambda: time.monotonic() > end)
    assert len(flight.service.presented) == 1
    flight.do(FlyTo(1350.0, 2380.0, 600.0, 10.0, 40.0, seconds=0.0))
    flight.until(lambda: len(flight.service.presented) == 2)
    flight.do(PresentView(False))
    flight.until(lambda: len(flight.service.presented) == 3)

    first, second, last = flight.service.presented
    assert first is not None
    assert second is not None
    assert (first.run, first.time, round(first.x), round(first.distance)) == (
        flight.shown.run,
        3.0 * INTERVAL,
        1250,
        600,
    )
    assert round(second.x) == 1350
    assert last is None


def test_a_follower_flies_where_the_presenter_is(flight: Flight) -> None:
    flight.do(Pause())
    flight.app.presenting.take(shown_by(flight))
    assert flight.app.fresh_status().presenters == (PresenterRow("anna", "fev-viewer"),)
    flight.do(FollowView("anna"))
    flight.until(lambda: where(flight) == (1300, 2400, 700))

    assert flight.app.clock.time == 5.0 * INTERVAL
    assert flight.app.fresh_status().followed == "anna"


def test_a_move_of_one_s_own_ends_following(flight: Flight) -> None:
    flight.app.presenting.take(shown_by(flight))
    flight.do(FollowView("anna"))
    assert flight.app.presenting.following == "anna"
    flight.do(DragOrbit(0.1, 0.0))

    assert flight.app.presenting.following is None


def test_the_end_of_a_presentation_gives_the_view_back(flight: Flight) -> None:
    flight.app.presenting.take(shown_by(flight))
    flight.do(FollowView("anna"))
    flight.app.presenting.take(protocol.ViewPresented("anna"))

    assert flight.app.presenting.following is None
    assert "over" in flight.app.message
    with pytest.raises(CommandError, match="'anna' presents no view; nobody does"):
        flight.do(FollowView("anna"))


def test_playing_is_followed_without_a_jump_for_every_view(flight: Flight) -> None:
    flight.do(Pause(), Seek(4.9 * INTERVAL))
    flight.app.presenting.take(shown_by(flight, playing=True))
    flight.do(FollowView("anna"))
    flight.until(lambda: flight.app.clock.is_playing)

    assert flight.app.clock.speed == 20.0
    assert 4.9 * INTERVAL <= flight.app.clock.time < 6.0 * INTERVAL


def test_another_run_of_the_presenter_is_shown(flight: Flight) -> None:
    other = flight.service.add_run()
    flight.app.desk.book.note_run(other.info)
    flight.app.presenting.take(shown_by(flight, other.info.run))
    flight.do(FollowView("anna"))
    flight.until(lambda: flight.shown.run == other.info.run and where(flight) == (1300, 2400, 700))

    assert flight.app.presenting.following == "anna"
    assert flight.app.clock.time == 5.0 * INTERVAL


def test_who_presents_does_not_follow(flight: Flight) -> None:
    flight.app.presenting.take(shown_by(flight))
    flight.do(FollowView("anna"), PresentView())

    assert (flight.app.presenting.following, flight.app.presenting.is_presenting) == (None, True)
    flight.do(FollowView("anna"))
    assert (flight.app.presenting.following, flight.app.presenting.is_presenting) == ("anna", False)


def test_the_run_of_the_presenter_is_asked_for_once_however_long_its_terrain_takes(
    flight: Flight, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = flight.service.add_run()
    flight.app.desk.book.note_run(other.info)
    asked: list[str] = []
    monkeypatch.setattr(flight.app.control, "select_run", asked.append)
    flight.app.presenting.take(shown_by(flight, other.info.run))
    flight.do(FollowView("anna"))
    end = time.monotonic() + 0.2
    flight.until(lambda: time.monotonic() > end)

    assert asked == [other.info.run]
