import dataclasses
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QInputDialog, QToolButton
from pytestqt.qtbot import QtBot

import protocol
from tests.viewer.gui.conftest import OpenWindow, Recorder
from viewer.commands import (
    BeginEdit,
    BeginLevelPick,
    BeginSelect,
    CancelEdit,
    ChangeEdit,
    ChangeEditSettings,
    DeleteEdit,
    FinishEdit,
    FlyTo,
    LoadEdits,
    Recalculate,
    Redo,
    RenameEdit,
    SaveEdits,
    SelectEdit,
    TopView,
    Undo,
)
from viewer.gui.edit_panel import EditPanel
from viewer.view_status import EditRow, EditSettings, ViewStatus

STATUS = ViewStatus(
    has_terrain=True,
    time=60.0,
    edits=(
        EditRow("a", "Raise by 8 m", True, settings=EditSettings(7.0, 8.0), name="North"),
        EditRow("b", "Lower by 2 m", False, kind="area"),
    ),
    can_undo=True,
    can_redo=True,
    can_recalculate=True,
    edit_settings=EditSettings(25.0, 4.0, "lower", "replace"),
)
SELECTED = dataclasses.replace(STATUS, selected_edit="a", edit_tool="select")


@pytest.fixture
def panel(qtbot: QtBot, record: Recorder) -> EditPanel:
    made = EditPanel(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def test_it_shows_settings_and_edits_without_making_commands(panel: EditPanel, record: Recorder) -> None:
    assert (panel.form.width_m.value(), panel.form.magnitude_m.value()) == (25.0, 4.0)
    assert panel.heading.text() == "Next edit"
    assert [panel.edits.item(row).text() for row in range(2)] == ["North: Raise by 8 m", "new: Lower by 2 m"]
    panel.show_status(SELECTED)
    assert (panel.form.width_m.value(), panel.heading.text()) == (7.0, "Selected: North")
    panel.show_status(dataclasses.replace(SELECTED, selected_edit="b"))
    assert not panel.form.width_m.isEnabled()
    assert record.commands == []


def test_settings_are_those_of_the_next_edit_or_of_the_selected_one(
    panel: EditPanel, record: Recorder
) -> None:
    panel.form.width_m.setValue(30.0)
    panel.form.crest.buttons["modulate"].click()
    panel.show_status(SELECTED)
    panel.form.magnitude_m.setValue(5.0)

    assert record.commands == [
        ChangeEditSettings(width=30.0),
        ChangeEditSettings(type="modulate", at_level=False),
        ChangeEdit(magnitude=5.0, edit="a"),
    ]


def test_a_tool_is_taken_and_put_away_by_its_button(panel: EditPanel, record: Recorder) -> None:
    for name, tool, command in (
        ("line", panel.line, BeginEdit("line")),
        ("area", panel.area, BeginEdit("area")),
        ("select", panel.select, BeginSelect()),
    ):
        tool.trigger()
        assert record.commands.pop() == command
        panel.show_status(dataclasses.replace(STATUS, edit_tool=name))
        assert [one.isChecked() for one in (panel.line, panel.area, panel.select)].count(True) == 1
        assert tool.isChecked()
        tool.trigger()
        assert record.commands.pop() == CancelEdit()
        panel.show_status(STATUS)


def test_the_level_is_taken_from_the_picture(panel: EditPanel, record: Recorder) -> None:
    panel.form.pick.click()
    panel.show_status(dataclasses.replace(STATUS, edit_tool="level"))
    assert panel.form.pick.isChecked()
    panel.form.pick.click()
    assert record.commands == [BeginLevelPick(), CancelEdit()]


def test_buttons_and_actions_become_commands(panel: EditPanel, record: Recorder, qtbot: QtBot) -> None:
    panel.undo.trigger()
    panel.redo.trigger()
    qtbot.mouseClick(panel.recalculate_button, Qt.MouseButton.LeftButton)
    assert record.commands == [Undo(), Redo(), Recalculate()]


def test_an_edit_is_selected_in_the_list_renamed_and_deleted(
    panel: EditPanel, record: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not panel.delete.isEnabled()
    panel.edits.setCurrentRow(1)
    panel.show_status(SELECTED)
    panel.delete.trigger()
    asked = []

    def answer(*arguments: object) -> tuple[str, bool]:
        asked.append(arguments[-1])
        return "West", True

    monkeypatch.setattr(QInputDialog, "getText", answer)
    panel.rename.trigger()
    panel.edits.itemDoubleClicked.emit(panel.edits.item(0))

    assert asked == ["North"]
    assert record.commands == [SelectEdit("b"), DeleteEdit(), RenameEdit("West", "a"), FlyTo(0.0, 0.0)]


def test_files_are_asked_for_and_a_dialog_that_is_closed_does_nothing(
    panel: EditPanel, record: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    for path in ("/tmp/edits.geojson", ""):
        monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_a, path=path: (path, ""))
        monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_a, path=path: (path, ""))
        panel.save.trigger()
        panel.load.trigger()
    assert record.commands == [SaveEdits("/tmp/edits.geojson"), LoadEdits("/tmp/edits.geojson")]


@pytest.mark.parametrize(("tool", "needed"), [("line", 2), ("area", 3)])
def test_what_is_drawn_can_be_finished_once_it_has_its_points(
    panel: EditPanel, record: Recorder, tool: str, needed: int
) -> None:
    for count in (needed - 1, needed):
        panel.show_status(ViewStatus(has_terrain=True, is_drawing=True, edit_tool=tool, drawn_vertices=count))
        assert panel.finish.isEnabled() == (count == needed)
    panel.finish.trigger()
    assert record.commands == [FinishEdit()]


def test_what_is_not_possible_is_greyed(panel: EditPanel) -> None:
    panel.show_status(ViewStatus(has_terrain=True, is_recalculating=True))

    for action in (panel.undo, panel.redo, panel.rename, panel.delete, panel.save, panel.finish):
        assert not action.isEnabled()
    assert not panel.recalculate_button.isEnabled()
    assert panel.recalculate_button.text() == "Recalculating ..."


def test_the_note_says_what_to_do_and_what_a_recalculation_took(panel: EditPanel) -> None:
    panel.show_status(ViewStatus(has_terrain=True, recalculate_latency_s=0.42))
    assert "0.42 s" in panel.note.text()
    notes = set()
    for tool in ("line", "area", "select", "level"):
        panel.show_status(ViewStatus(has_terrain=True, edit_tool=tool, drawn_vertices=4))
        notes.add(panel.note.text())
    assert len(notes) == 3
    assert all(notes)


def test_every_button_has_a_name_and_a_tip_and_the_menu_has_all_actions(panel: EditPanel) -> None:
    buttons = panel.findChildren(QToolButton)
    assert {button.accessibleName() for button in buttons} >= {
        "Draw line",
        "Undo edit",
        "Delete",
    }
    assert {button.text() for button in buttons} >= {"Line", "Area", "Select", "Undo", "Redo"}
    assert all(button.toolTip() for button in buttons)
    actions = {action for action in panel.menu_actions() if action is not None}
    assert {button.defaultAction() for button in buttons} | {panel.recalculate} == actions


def test_a_person_draws_moves_names_deletes_and_keeps_edits(
    opened: OpenWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    app, window, bot = opened.app, opened.window, opened.bot
    panel, scene = window.edit_panel, window.scene

    def edits() -> tuple[protocol.Edit, ...]:
        return app.shown.document.edits if app.shown is not None else ()

    def drag(*places: tuple[float, float]) -> None:
        bot.mousePress(scene, Qt.MouseButton.LeftButton, pos=opened.pixel_of(*places[0]))
        for place in places[1:]:
            pictures = scene.pictures
            bot.mouseMove(scene, opened.pixel_of(*place))
            opened.until(lambda pictures=pictures: scene.pictures > pictures)
        bot.mouseRelease(scene, Qt.MouseButton.LeftButton, pos=opened.pixel_of(*places[-1]))

    app.dispatch(ChangeEditSettings(width=30.0, magnitude=2.0))
    app.dispatch(TopView())
    opened.until(lambda: app.is_settled)
    bot.keyClick(scene, Qt.Key.Key_B, Qt.KeyboardModifier.ShiftModifier)
    opened.until(lambda: opened.status.edit_tool == "area")
    corners = ((1600.0, 2150.0), (1700.0, 2150.0), (1700.0, 2250.0))
    for number, corner in enumerate(corners, 1):
        opened.click(*corner)
        opened.until(lambda number=number: opened.status.drawn_vertices == number)
    opened.click(*corners[0])
    opened.until(lambda: len(edits()) == 1 and not app.is_busy)
    assert isinstance(edits()[0], protocol.EditArea)

    bot.keyClick(scene, Qt.Key.Key_B)
    opened.until(lambda: opened.status.edit_tool == "line")
    drag(*((1300.0 + 20.0 * step, 2200.0) for step in range(8)), (1440.0, 2300.0), (1440.0, 2400.0))
    bot.keyClick(scene, Qt.Key.Key_Return)
    opened.until(lambda: len(edits()) == 2 and not app.is_busy)
    line = edits()[1]
    np.testing.assert_allclose(line.vertices, [(1300, 2200), (1440, 2200), (1440, 2400)], atol=15.0)

    bot.keyClick(scene, Qt.Key.Key_X)
    opened.until(lambda: opened.status.edit_tool == "select")
    drag((1370.0, 2200.0), (1370.0, 2230.0), (1370.0, 2280.0))
    opened.until(lambda: edits()[1].vertices != line.vertices and not app.is_busy)
    np.testing.assert_allclose(edits()[1].vertices, np.add(line.vertices, (0.0, 80.0)), atol=15.0)
    opened.until(lambda: bool(panel.edits.selectedItems()))

    monkeypatch.setattr(QInputDialog, "getText", lambda *_arguments: ("Levee", True))
    bot.keyClick(scene, Qt.Key.Key_F2)
    opened.until(lambda: edits()[1].name == "Levee" and not app.is_busy)
    path = tmp_path / "edits.geojson"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_arguments: (str(path), ""))
    panel.save.trigger()
    kept = edits()
    bot.keyClick(scene, Qt.Key.Key_Delete)
    opened.until(lambda: len(edits()) == 1 and not app.is_busy)
    for _ in range(2):
        opened.until(panel.undo.isEnabled)
        revision = opened.status.revision
        bot.keyClick(scene, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
        opened.until(lambda revision=revision: opened.status.revision > revision and not app.is_busy)
    assert [edit.name for edit in edits()] == ["", ""]
    for _ in range(4):
        bot.keyClick(scene, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
        bot.wait(120)
    opened.until(lambda: edits() == () and not app.is_busy)
    opened.until(lambda: panel.edits.count() == 2)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_arguments: (str(path), ""))
    panel.load.trigger()
    opened.until(lambda: not app.is_busy and len(edits()) == 2)
    assert edits() == kept
