"""Commands about one run reach the service, and the book of runs tells what came of them."""

import pytest

import protocol
from tests.viewer.app.conftest import Flight
from viewer.commands import (
    Command,
    CommandError,
    DeleteRun,
    PauseRun,
    PinRun,
    ReleaseControl,
    RenameRun,
    ResumeRun,
    StopRun,
    TakeControl,
    UnpinRun,
)
from viewer.view_status import RunRow


def row(flight: Flight, run: str = "run-1") -> RunRow:
    return next(each for each in flight.app.desk.book.run_rows() if each.run == run)


@pytest.mark.parametrize("run", [None, "run-1"])
def test_pause_resume_and_stop_change_the_run(flight: Flight, run: str | None) -> None:
    commands: tuple[tuple[Command, str], ...] = (
        (PauseRun(run), "paused"),
        (ResumeRun(run), "running"),
        (StopRun(run), "stopped"),
    )
    for command, status in commands:
        flight.app.carry_out(command)
        flight.until(lambda status=status: row(flight).status == status)  # type: ignore[misc]


def test_a_run_is_named_and_pinned(flight: Flight) -> None:
    flight.app.carry_out(RenameRun("with the levee"))
    flight.until(lambda: row(flight).label == "with the levee")
    flight.app.carry_out(PinRun())
    flight.until(lambda: row(flight).pinned)
    flight.app.carry_out(UnpinRun())
    flight.until(lambda: not row(flight).pinned)


def test_a_deleted_run_leaves_the_book(flight: Flight) -> None:
    other = flight.service.add_run().info
    flight.app.desk._handle(protocol.RunChanged(other))
    flight.app.carry_out(DeleteRun(other.run))
    flight.until(lambda: other.run not in flight.app.desk.book.runs)


def test_control_is_taken_and_handed_over(flight: Flight) -> None:
    flight.app.carry_out(TakeControl())
    flight.until(lambda: row(flight).controller == ("s1", "tiny"))
    flight.app.desk._handle(protocol.ControlRequested("run-1", "s7", "another viewer"))
    assert row(flight).asker == "s7"
    assert "another viewer (s7) asks for the control" in flight.app.message
    flight.app.carry_out(ReleaseControl(to="s7"))
    flight.until(lambda: row(flight).controller == ("s7", "tiny"))
    assert row(flight).asker == ""
    flight.app.carry_out(ReleaseControl())
    flight.until(lambda: row(flight).controller == ("", ""))


def test_a_run_that_is_unknown_is_refused_in_words(flight: Flight) -> None:
    with pytest.raises(CommandError, match="run 'run-9' is unknown"):
        flight.app.carry_out(PauseRun("run-9"))


def test_a_resumed_run_takes_its_stream_back_first(flight: Flight) -> None:
    asked = []
    flight.app.control.steering.resuming = lambda: asked.append(True)
    flight.app.carry_out(ResumeRun())

    assert asked == [True]
