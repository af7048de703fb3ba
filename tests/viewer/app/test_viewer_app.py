"""The state machine against a service on a real socket: what a user does, without a window."""

import numpy as np
import pytest

from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import FRAMES, INTERVAL, TinyService, flood, valley
from viewer.commands import (
    AddVertex,
    BeginEdit,
    CommandError,
    FinishEdit,
    MoveHover,
    Pause,
    Play,
    ProbeAt,
    Recalculate,
    Redo,
    Seek,
    SelectRun,
    SetOption,
    SetSpeed,
    StartRun,
    TopView,
    Undo,
)


def water_at(flight: Flight) -> np.ndarray:
    pair = flight.app.feed.pair
    assert pair is not None
    return (1.0 - pair.alpha) * pair.first.h + pair.alpha * pair.second.h


def draw_levee(flight: Flight, x: float = 1400.0) -> None:
    flight.do(BeginEdit(), AddVertex(x, 2200.0), AddVertex(x, 2520.0), FinishEdit())
    flight.until(lambda: not flight.app.is_busy)


def test_a_started_run_appears_and_is_followed_live(flight: Flight) -> None:
    flight.until(lambda: flight.app.clock.time > 18.5 * INTERVAL)
    status = flight.app.fresh_status()

    assert (status.title, status.hypothetical, status.follows_live) == ("Tiny valley", True, True)
    assert status.computed_until == 19 * INTERVAL
    np.testing.assert_array_equal(flight.shown.heightfield.z_b, valley())


def test_the_water_on_the_picture_is_that_of_the_playback_time(flight: Flight) -> None:
    flight.do(Pause(), Seek(7.25 * INTERVAL))
    flight.settle()

    expected = 0.75 * flood(7) + 0.25 * flood(8)
    np.testing.assert_allclose(water_at(flight), expected, atol=0.002)


def test_seeking_beyond_what_is_computed_ends_at_the_newest_frame(flight: Flight) -> None:
    flight.do(Pause(), Seek(1e6))
    flight.settle()

    assert flight.app.clock.time == 19 * INTERVAL


def test_play_runs_at_the_chosen_speed_and_pause_holds(flight: Flight) -> None:
    flight.do(Pause(), Seek(0.0), SetSpeed(100.0), Play())
    flight.until(lambda: flight.app.clock.time > 20.0)
    flight.do(Pause())
    held = flight.app.clock.time
    flight.until(lambda: flight.app.is_settled)

    assert flight.app.clock.time == held
    assert not flight.app.fresh_status().is_playing


def test_an_edit_is_previewed_while_it_is_drawn_and_listed_when_finished(flight: Flight) -> None:
    flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), MoveHover(1400.0, 2520.0))
    flight.until(lambda: bool(flight.shown.heightfield.z_b[40, 40] > valley()[40, 40] + 7.0))
    assert flight.app.fresh_status().edits == ()
    flight.do(AddVertex(1400.0, 2520.0), FinishEdit())
    flight.until(lambda: len(flight.app.fresh_status().edits) == 1)
    status = flight.app.fresh_status()

    assert not status.is_drawing
    assert not status.edits[0].is_applied
    assert status.can_undo
    assert flight.shown.heightfield.z_b[40, 40] == np.float32(valley()[40, 40] + np.float32(8.0))


def test_undo_takes_the_ground_back_and_redo_brings_it_again(flight: Flight) -> None:
    flight.do(Pause())
    draw_levee(flight)
    flight.do(Undo())
    flight.until(lambda: flight.app.fresh_status().edits == ())
    flight.until(lambda: bool(np.array_equal(flight.shown.heightfield.z_b, valley())))
    assert flight.app.fresh_status().can_redo
    flight.do(Redo())
    flight.until(lambda: len(flight.app.fresh_status().edits) == 1)

    flight.until(lambda: bool(flight.shown.heightfield.z_b[40, 40] > valley()[40, 40]))


def test_recalculate_moves_to_the_branch_keeps_the_past_and_changes_the_future(flight: Flight) -> None:
    flight.do(Pause(), Seek(10 * INTERVAL))
    parent = flight.shown.run
    draw_levee(flight)
    flight.do(Recalculate())
    flight.until(lambda: flight.shown.run != parent and not flight.app.is_busy)
    assert flight.app.clock.time == 10 * INTERVAL
    assert flight.app.fresh_status().branch_time == 10 * INTERVAL
    assert flight.app.fresh_status().edits[0].is_applied
    flight.service.computed = FRAMES
    flight.have_frames(35)
    flight.do(Seek(30 * INTERVAL))
    flight.settle()
    assert flight.app.feed.keys is not None
    assert flight.app.feed.keys[0] == (flight.shown.run, 30)
    assert water_at(flight)[36, 45] == 0.0
    flight.do(Seek(5 * INTERVAL))
    flight.settle()

    assert flight.app.feed.keys[0] == (parent, 5)
    np.testing.assert_allclose(water_at(flight), flood(5), atol=0.002)


def test_the_latency_of_a_recalculation_ends_with_its_first_frame_on_the_picture(flight: Flight) -> None:
    flight.do(Pause(), Seek(10 * INTERVAL))
    draw_levee(flight)
    flight.do(Recalculate())
    flight.until(lambda: not flight.app.is_busy)
    latency = flight.app.fresh_status().recalculate_latency_s

    assert latency is not None
    assert 0.0 < latency < 5.0


def test_recalculate_pressed_before_the_edit_is_confirmed_waits_for_it(flight: Flight) -> None:
    flight.do(Pause(), Seek(10 * INTERVAL), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2520.0))
    flight.do(FinishEdit(), Recalculate())
    parent = flight.shown.run
    flight.until(lambda: flight.shown.run != parent)

    assert len(flight.service.runs[flight.shown.run].edits) == 1


def test_the_parent_can_be_shown_again(flight: Flight) -> None:
    flight.do(Pause(), Seek(10 * INTERVAL))
    parent = flight.shown.run
    draw_levee(flight)
    flight.do(Recalculate())
    flight.until(lambda: flight.shown.run != parent and not flight.app.is_busy)
    flight.do(SelectRun(parent), Seek(19 * INTERVAL))
    flight.settle()

    np.testing.assert_allclose(water_at(flight), flood(19), atol=0.002)
    assert [row.parent for row in flight.app.fresh_status().runs] == [None, parent]


def test_after_a_cut_the_picture_stays_and_the_stream_goes_on(flight: Flight) -> None:
    flight.do(Pause(), Seek(12 * INTERVAL))
    flight.settle()
    before = water_at(flight)
    flight.service.cut()
    flight.until(lambda: not flight.app.fresh_status().is_connected)
    inputs = flight.app.frame_inputs()
    assert inputs is not None
    assert inputs.hud is not None
    assert "reconnecting in" in inputs.hud.notice or "connecting to" in inputs.hud.notice
    assert "This picture is 00:00:0" in inputs.hud.notice
    assert inputs.is_outdated
    np.testing.assert_array_equal(water_at(flight), before)
    flight.service.computed = 30
    flight.have_frames(30)
    inputs = flight.app.frame_inputs()

    assert inputs is not None
    assert not inputs.is_outdated
    assert len(flight.service.hellos) == 2
    assert flight.service.hellos[1].resume is not None
    assert flight.service.hellos[1].resume.run == flight.shown.run


def test_the_point_under_the_pointer_and_the_probed_point_are_read(flight: Flight) -> None:
    flight.do(Pause(), Seek(19 * INTERVAL))
    flight.settle()
    flight.do(MoveHover(1205.0, 2365.0), ProbeAt(1105.0, 2365.0))
    flight.until(lambda: len(flight.app.fresh_status().depth_record[0]) == 20)
    status = flight.app.fresh_status()

    assert status.hover is not None
    assert status.hover.depth == pytest.approx(2.0, abs=0.002)
    assert status.hover.level == pytest.approx(status.hover.ground + status.hover.depth)
    times, depths = status.depth_record
    assert times == tuple(index * INTERVAL for index in range(20))
    assert depths == pytest.approx([float(flood(index)[36, 10]) for index in range(20)], abs=0.002)


@pytest.mark.parametrize(
    ("command", "complaint"),
    [
        (Seek(float("nan")), "finite"),
        (SetSpeed(0.0), "above 0"),
        (AddVertex(1.0, 1.0), "BeginEdit first"),
        (FinishEdit(), "at least two points"),
        (SelectRun("nobody"), "unknown"),
        (SetOption("wireframe", 3.0), "true or false"),
        (SetOption("exaggeration", 1e9), "from 0.1 to 20"),
        (SetOption("colour", "red"), "unknown"),
    ],
)
def test_what_makes_no_sense_is_refused_in_one_sentence(
    flight: Flight, command: object, complaint: str
) -> None:
    with pytest.raises(CommandError, match=complaint):
        flight.app.carry_out(command)  # type: ignore[arg-type]
    flight.app.dispatch(command)  # type: ignore[arg-type]

    assert complaint in flight.app.message


def test_without_a_run_only_the_program_answers() -> None:
    flight = Flight(TinyService(), start=False)
    flight.until(lambda: len(flight.app.fresh_status().cases) == 1)

    assert flight.app.frame_inputs() is None
    assert flight.app.heightfield is None
    with pytest.raises(CommandError, match="no run is shown"):
        flight.app.carry_out(Recalculate())
    with pytest.raises(CommandError, match="before a terrain"):
        flight.app.carry_out(TopView())
    flight.close()


def test_a_refused_start_is_told(flight: Flight) -> None:
    flight.do(StartRun("nowhere"))
    flight.until(lambda: "unknown" in flight.app.message)

    assert "start nowhere" in flight.app.message
