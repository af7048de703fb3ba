import pytest

from tests.viewer.app.conftest import Flight
from tests.viewer.app.test_comparison import branched
from tests.viewer.tiny_service import INTERVAL
from viewer.commands import CompareWith, Pause, ProbeAt, Seek

IN_THE_STREAM = (1045.0, 2365.0)
DRY = (1045.0, 2015.0)


def test_a_click_brings_speed_and_direction_blended_as_the_depth_is(flight: Flight) -> None:
    flight.do(Pause(), Seek(7.5 * INTERVAL), ProbeAt(*IN_THE_STREAM))
    flight.settle()
    flight.until(lambda: (probe := flight.app.fresh_status().probe) is not None and probe.speed is not None)
    probe = flight.app.fresh_status().probe

    assert probe is not None
    assert probe.speed == pytest.approx(0.75, abs=1e-3)
    assert probe.bearing == pytest.approx(90.0)
    assert probe.depth == pytest.approx(2.0, abs=0.01)


def test_dry_ground_has_no_speed(flight: Flight) -> None:
    flight.do(Pause(), Seek(7.5 * INTERVAL), ProbeAt(*DRY))
    flight.settle()
    flight.until(lambda: len(flight.app.fresh_status().speed_record[0]) > 2)
    probe = flight.app.fresh_status().probe

    assert probe is not None
    assert probe.speed is None
    assert set(flight.app.fresh_status().speed_record[1]) == {0.0}


def test_the_record_of_speeds_fills_while_nothing_else_is_asked_for(flight: Flight) -> None:
    flight.do(Pause(), Seek(3 * INTERVAL), ProbeAt(*IN_THE_STREAM))
    flight.until(lambda: len(flight.app.fresh_status().speed_record[0]) >= 20)
    times, speeds = flight.app.fresh_status().speed_record

    assert list(times) == [index * INTERVAL for index in range(20)]
    assert list(speeds) == pytest.approx([0.1 * index for index in range(20)], abs=2e-3)


def test_both_runs_have_their_records_when_they_are_compared(flight: Flight) -> None:
    parent, _ = branched(flight)
    flight.do(Seek(30 * INTERVAL), CompareWith(parent, "swipe"), ProbeAt(1605.0, 2365.0))
    flight.until(lambda: len(flight.app.fresh_status().other_depth_record[0]) >= 35)
    status = flight.app.fresh_status()

    assert max(status.depth_record[1]) == 0.0
    assert max(status.other_depth_record[1]) == pytest.approx(2.0, abs=0.01)
