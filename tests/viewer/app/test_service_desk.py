"""The desk against the tiny service; what the state machine makes of it is tested with the state machine."""

import time

import protocol
from tests.viewer.app.conftest import Flight
from viewer.app.service_desk import CREDIT


def test_cases_runs_and_devices_are_known_once_connected(flight: Flight) -> None:
    desk = flight.app.desk

    assert [case.name for case in desk.book.cases] == ["tiny"]
    assert list(desk.book.runs) == ["run-1"]
    assert desk.devices == ("cpu",)
    assert desk.is_open
    assert desk.connection_sentence() == f"connected to {flight.service.url}"


def test_the_age_of_the_data_counts_from_when_the_connection_stood_last(flight: Flight) -> None:
    desk = flight.app.desk
    stood = time.monotonic()
    flight.service.close()
    flight.until(lambda: not desk.is_open)
    lost = time.monotonic()

    age = desk.data_age(lost + 60.0)
    assert age is not None
    assert 60.0 <= age <= 60.0 + (lost - stood) + 1.0


def test_every_frame_taken_lets_another_one_come(flight: Flight) -> None:
    flight.service.computed = 40
    flight.have_frames(40)

    assert CREDIT < 40


def test_a_run_that_somebody_else_branched_is_told_and_listed(flight: Flight) -> None:
    child = flight.service.add_run(flight.service.runs["run-1"], 5).info
    flight.app.desk._handle(protocol.RunBranched("run-1", child))

    assert "recalculated this run" in flight.app.message
    assert flight.shown.run == "run-1"
    assert child.run in flight.app.desk.book.runs
