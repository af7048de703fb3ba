import msgspec
import pytest

import protocol
from tests.viewer.app.conftest import Flight
from tests.viewer.app.test_picture_text import shown
from tests.viewer.app.test_run_book import edit, info
from viewer.app.edit_report import edit_overlay, edit_rows, edit_text, undone_rows
from viewer.app.levee_watch import LeveeWatch
from viewer.commands import AddVertex, BeginEdit, DragEdit, FinishEdit, GrabEdit, MoveHover, Pause, SelectEdit
from viewer.render import LineStyle
from viewer.units import METRIC, US

REPLACE = protocol.EditType.replace
AREA = protocol.EditArea(
    "pit",
    ((1100.0, 2100.0), (1200.0, 2100.0), (1200.0, 2300.0)),
    protocol.Operation.lower,
    protocol.EditType.modulate,
    2.5,
    name="Pit",
)


def test_what_is_drawn_lies_on_the_ground_with_the_edits(flight: Flight) -> None:
    editing = flight.app.control.editing
    assert edit_overlay(flight.shown, editing) is None
    flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0), FinishEdit())
    flight.until(lambda: not flight.app.is_busy)
    flight.do(
        BeginEdit("area"), AddVertex(1100.0, 2100.0), AddVertex(1200.0, 2100.0), MoveHover(1200.0, 2200.0)
    )
    overlay = edit_overlay(flight.shown, editing)

    assert overlay is not None
    assert [line.style for line in overlay.lines] == [LineStyle.RAISE, LineStyle.DRAFT]
    assert overlay.lines[1].vertices == (
        (1100.0, 2100.0),
        (1200.0, 2100.0),
        (1200.0, 2200.0),
        (1100.0, 2100.0),
    )
    assert overlay.sign.max() == 1


def test_the_selected_edit_is_marked_where_it_is_being_moved_to(flight: Flight) -> None:
    editing = flight.app.control.editing
    flight.do(Pause(), BeginEdit(), AddVertex(1400.0, 2200.0), AddVertex(1400.0, 2500.0), FinishEdit())
    flight.until(lambda: not flight.app.is_busy)
    (made,) = flight.shown.document.edits
    flight.do(SelectEdit(made.id), GrabEdit(1400.0, 2350.0), DragEdit(1450.0, 2350.0))
    overlay = edit_overlay(flight.shown, editing)

    assert overlay is not None
    assert [(line.style, line.vertices) for line in overlay.lines] == [
        (LineStyle.SELECTED, ((1450.0, 2200.0), (1450.0, 2500.0)))
    ]


def test_an_edit_counts_as_computed_only_when_the_run_has_it_as_it_is() -> None:
    run = shown(info("a"))
    one, two, three = edit("one"), edit("two"), edit("three")
    run.document.mirror(1, [one, two, three], True, False)
    changed = msgspec.structs.replace(two, magnitude=99.0)
    renamed = msgspec.structs.replace(three, name="Third")
    rows = edit_rows(run, [one, changed, renamed], LeveeWatch(), METRIC)

    assert [(row.id, row.is_applied, row.warning) for row in rows] == [
        ("one", True, ""),
        ("two", False, ""),
        ("three", True, ""),
    ]
    assert all(" long, " in row.measure and row.measure.endswith(" m\u00b3 of fill") for row in rows)


def test_a_row_has_what_the_panel_needs_to_show_and_change_an_edit() -> None:
    run = shown(info("a"))
    run.document.mirror(1, [AREA], True, True, [edit("gone")])
    (row,), (gone,) = edit_rows(run, [], LeveeWatch(), METRIC), undone_rows(run, METRIC)

    assert (row.name, row.kind, row.centre) == ("Pit", "area", (1150.0, 2200.0))
    assert (row.settings.operation, row.settings.magnitude, row.settings.at_level) == ("lower", 2.5, False)
    assert row.measure.endswith(" m\u00b3 of cut")
    assert (gone.id, gone.kind, gone.measure) == ("gone", "line", "")


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({}, "Raise by 8 m, 40 m wide, 2 points"),
        (
            {"type": protocol.EditType.replace, "reference_z": (1.0, 2.0)},
            "Raise to an even 8 m, 40 m wide, 2 points",
        ),
        ({"type": protocol.EditType.replace, "level": 312.25}, "Raise to 312.25 m, 40 m wide, 2 points"),
        ({"operation": protocol.Operation.lower}, "Lower by 8 m, 40 m wide, 2 points"),
    ],
)
def test_an_edit_is_told_in_words(changes: dict[str, object], text: str) -> None:
    line = protocol.EditLine(
        "a",
        ((1100.0, 2100.0), (1200.0, 2100.0)),
        40.0,
        protocol.Operation.raise_,
        protocol.EditType.modulate,
        8.0,
    )
    assert edit_text(msgspec.structs.replace(line, **changes), METRIC) == text


def test_an_edit_is_told_in_the_units_wanted() -> None:
    assert edit_text(msgspec.structs.replace(AREA, magnitude=3.048), US) == "Lower area by 10 ft"
