"""Two runs of the tiny service: a flood with a levee against the one without."""

import pytest

import protocol
from tests.viewer.app.conftest import Flight
from tests.viewer.app.test_viewer_app import draw_levee
from tests.viewer.tiny_service import FRAMES, INTERVAL
from viewer.commands import CommandError, CompareWith, Pause, PauseRun, Recalculate, Seek, SelectRun


def branched(flight: Flight) -> tuple[str, str]:
    """The parent and its branch with a levee, both computed and at hand."""
    flight.service.computed = FRAMES
    flight.have_frames(FRAMES)
    parent = flight.shown.run
    flight.do(Pause(), Seek(10 * INTERVAL))
    draw_levee(flight)
    flight.do(Recalculate())
    flight.until(lambda: flight.shown.run != parent and not flight.app.is_busy)
    flight.have_frames(FRAMES)
    return parent, flight.shown.run


def test_behind_the_levee_the_branch_has_less_water(flight: Flight) -> None:
    parent, _ = branched(flight)
    flight.do(Seek(30 * INTERVAL))
    flight.settle()
    flight.do(CompareWith(parent))
    flight.until(lambda: flight.app.comparison.difference is not None)
    difference = flight.app.comparison.difference

    assert difference is not None
    assert difference.metres.min() == pytest.approx(-2.0, abs=0.01)
    assert difference.metres[36, 60] == pytest.approx(-2.0, abs=0.01)
    assert difference.metres[36, 5] == 0.0
    assert difference.other == "run tiny"
    inputs = flight.app.frame_inputs()
    assert inputs is not None
    assert inputs.difference is difference
    assert flight.app.fresh_status().compared_run == parent


def test_seen_from_the_parent_the_signs_turn(flight: Flight) -> None:
    parent, child = branched(flight)
    flight.do(SelectRun(parent), Seek(30 * INTERVAL))
    flight.settle()
    flight.do(CompareWith(child))
    flight.until(lambda: flight.app.comparison.difference is not None)
    difference = flight.app.comparison.difference

    assert difference is not None
    assert difference.metres[36, 60] == pytest.approx(2.0, abs=0.01)
    assert difference.other == "branch from 00:01:40"


def test_in_the_shared_past_there_is_no_difference(flight: Flight) -> None:
    parent, _ = branched(flight)
    flight.do(Seek(30 * INTERVAL))
    flight.settle()
    flight.do(CompareWith(parent))
    flight.until(lambda: flight.app.comparison.difference is not None)
    flight.do(Seek(5 * INTERVAL))
    flight.settle()

    flight.until(lambda: flight.app.comparison.difference is None)


def test_it_ends_on_request_and_when_the_other_run_comes_on_the_picture(flight: Flight) -> None:
    parent, child = branched(flight)
    flight.do(Seek(30 * INTERVAL))
    flight.settle()
    flight.do(CompareWith(parent))
    flight.until(lambda: flight.app.comparison.difference is not None)
    flight.do(CompareWith(None))
    assert flight.app.comparison.difference is None
    flight.do(CompareWith(parent), SelectRun(parent))
    flight.until(lambda: flight.shown.run == parent and flight.app.comparison.other is None)

    with pytest.raises(CommandError, match="itself"):
        flight.do(CompareWith(parent))
    with pytest.raises(CommandError, match="unknown"):
        flight.do(CompareWith("nobody"))
    flight.do(CompareWith(child))


def test_a_run_that_was_never_watched_is_fetched_and_the_stream_given_back(flight: Flight) -> None:
    flight.service.computed = FRAMES
    flight.have_frames(FRAMES)
    other = flight.service.add_run().info
    flight.app.desk._handle(protocol.RunChanged(other))
    flight.do(PauseRun())
    flight.until(lambda: flight.shown.info.status == "paused")
    flight.do(Pause(), Seek(30 * INTERVAL))
    flight.settle()
    flight.do(CompareWith(other.run))
    flight.until(lambda: flight.app.comparison.difference is not None)
    difference = flight.app.comparison.difference

    assert difference is not None
    assert not difference.metres.any()
