import pytest

import protocol
from tests.viewer.app.conftest import Flight
from viewer.commands import AddVertex, BeginEdit, CancelEdit, CommandError, FinishEdit, Pause, SetSpeed


def test_other_commands_are_left_to_others(flight: Flight) -> None:
    assert not flight.app.control.editing.carry_out(SetSpeed(2.0), flight.shown)


def test_without_a_run_there_is_nothing_to_edit(flight: Flight) -> None:
    with pytest.raises(CommandError, match="no run is shown"):
        flight.app.control.editing.carry_out(BeginEdit(), None)


def test_a_dropped_line_leaves_the_ground_as_it_was(flight: Flight) -> None:
    base = flight.shown.document.base
    flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0))
    flight.until(lambda: bool((flight.shown.heightfield.z_b != base).any()))
    flight.do(CancelEdit())

    flight.until(lambda: bool((flight.shown.heightfield.z_b == base).all()))
    assert not flight.app.control.editing.drawing.is_on


def test_a_finished_line_stays_on_the_ground_until_the_service_has_it(flight: Flight) -> None:
    editing = flight.app.control.editing
    with flight.service.lock:  # the service answers nothing now
        flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0), FinishEdit())
        assert editing.unconfirmed is not None
        assert flight.shown.document.draft is editing.unconfirmed
    flight.until(lambda: editing.unconfirmed is None)

    assert flight.shown.document.draft is None
    assert len(flight.shown.document.edits) == 1


def test_a_line_the_service_refuses_is_taken_off_again(flight: Flight) -> None:
    service_run = flight.service.runs[flight.shown.run]
    for number in range(protocol.limits.MAX_EDITS):
        service_run.log.append(
            protocol.EditLine(
                id=f"e{number}",
                vertices=((1100.0, 2100.0), (1110.0, 2100.0)),
                width=10.0,
                operation=protocol.Operation.raise_,
                type=protocol.EditType.modulate,
                magnitude=1.0,
            )
        )
    flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0), FinishEdit())
    flight.until(lambda: "add the edit" in flight.app.message)

    assert flight.app.control.editing.unconfirmed is None
    assert flight.shown.document.draft is None
