from pathlib import Path

import pytest

import protocol
from tests.viewer.app.conftest import Flight
from tests.viewer.app.test_editing import levee, taken
from viewer.app.edit_geojson import EditFileError, text_of_edits
from viewer.commands import (
    ChangeEdit,
    CommandError,
    DeleteEdit,
    LoadEdits,
    MoveEdit,
    MoveVertex,
    Recalculate,
    Redo,
    RenameEdit,
    SaveEdits,
    SelectEdit,
    Undo,
)


def test_an_edit_is_moved_bent_changed_renamed_and_deleted_and_all_of_it_is_undone(flight: Flight) -> None:
    made = levee(flight)
    flight.do(SelectEdit(made.id))
    states = [flight.shown.document.edits]
    for command in (
        MoveEdit(20.0, 0.0),
        MoveVertex(1, 1500.0, 2480.0),
        ChangeEdit(width=60.0, type="replace"),
        RenameEdit("North levee"),
        DeleteEdit(),
    ):
        states.append(taken(flight, command))
    assert [len(state) for state in states] == [1, 1, 1, 1, 1, 0]
    assert states[1][0].vertices == ((1420.0, 2200.0), (1420.0, 2500.0))
    assert states[2][0].vertices == ((1420.0, 2200.0), (1500.0, 2480.0))
    assert states[3][0].reference_z is not None
    assert states[4][0].name == "North levee"
    assert len(set(states)) == 6
    for state in reversed(states[:-1]):
        assert taken(flight, Undo()) == state
    for state in states[1:]:
        assert taken(flight, Redo()) == state


def test_a_change_that_changes_nothing_is_not_asked_for(flight: Flight) -> None:
    made = levee(flight)
    before = flight.shown.document.revision
    flight.do(MoveEdit(0.0, 0.0, made.id), RenameEdit("", made.id), ChangeEdit(edit=made.id))
    assert not flight.app.is_busy
    assert flight.shown.document.revision == before


def test_without_a_selection_the_edit_must_be_named(flight: Flight) -> None:
    levee(flight)
    for command in (MoveEdit(1.0, 1.0), DeleteEdit(), RenameEdit("a"), ChangeEdit(width=3.0)):
        with pytest.raises(CommandError, match="no edit is selected"):
            flight.do(command)
    with pytest.raises(protocol.EditError, match="'nobody'"):
        flight.do(DeleteEdit("nobody"))


def test_a_recalculation_waits_for_a_change_of_the_list(flight: Flight) -> None:
    first, second = levee(flight), levee(flight, 1500.0)
    parent = flight.shown.run
    with flight.service.lock:
        flight.do(DeleteEdit(first.id), Recalculate())
        assert flight.app.recalculated is None
    flight.until(lambda: flight.shown.run != parent and not flight.app.is_busy)
    assert flight.app.recalculated is not None
    assert flight.app.recalculated.edits == (second,)


def test_a_change_that_is_refused_is_told_and_the_recalculation_that_waited_is_dropped(
    flight: Flight,
) -> None:
    made = levee(flight)
    flight.service.runs[flight.shown.run].log.delete(made.id)  # by somebody else
    flight.do(MoveEdit(20.0, 0.0, made.id), Recalculate())
    flight.until(lambda: "change the edit" in flight.app.message)

    assert not flight.app.is_busy
    assert flight.app.recalculated is None
    assert flight.shown.document.draft is None


def test_edits_are_written_to_a_file_and_read_back_as_they_were(flight: Flight, tmp_path: Path) -> None:
    levee(flight)
    made = taken(flight, RenameEdit("One", levee(flight, 1500.0).id))
    path = tmp_path / "edits.geojson"
    flight.do(SaveEdits(str(path)))
    assert [file.name for file in tmp_path.iterdir()] == ["edits.geojson"]
    taken(flight, DeleteEdit(made[0].id))
    taken(flight, DeleteEdit(made[1].id))
    assert taken(flight, LoadEdits(str(path))) == made
    assert taken(flight, Undo()) == ()


def test_a_large_file_comes_in_parts_that_a_service_takes(flight: Flight, tmp_path: Path) -> None:
    edits = [
        protocol.EditLine(
            f"e{number}",
            tuple((1100.0 + n % 7, 2100.0 + n % 11) for n in range(40)),
            10.0,
            protocol.Operation.raise_,
            protocol.EditType.modulate,
            1.0,
        )
        for number in range(300)
    ]
    path = tmp_path / "many.geojson"
    path.write_bytes(text_of_edits(edits, flight.shown.grid))
    assert list(taken(flight, LoadEdits(str(path)))) == edits
    assert flight.shown.document.revision == 3  # 40 x 102, 40 x 102, the rest


def test_a_file_that_cannot_be_read_or_written_is_told_and_changes_nothing(
    flight: Flight, tmp_path: Path
) -> None:
    made = levee(flight)
    with pytest.raises(EditFileError, match="cannot be read"):
        flight.do(LoadEdits(str(tmp_path / "none.geojson")))
    with pytest.raises(EditFileError, match="cannot be written"):
        flight.do(SaveEdits(str(tmp_path / "none" / "edits.geojson")))
    empty = tmp_path / "empty.geojson"
    empty.write_bytes(text_of_edits([], flight.shown.grid))
    with pytest.raises(CommandError, match="has no edits"):
        flight.do(LoadEdits(str(empty)))
    assert not flight.app.is_busy
    assert flight.shown.document.edits == (made,)
