import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import BeginEdit, CancelEdit, ChangeEditSettings, FinishEdit, Recalculate, Redo, Undo
from viewer.gui.edit_panel import EditPanel
from viewer.view_status import EditRow, EditSettings, ViewStatus

STATUS = ViewStatus(
    has_terrain=True,
    time=60.0,
    edits=(EditRow("a", "Raise by 8 m", True), EditRow("b", "Lower by 2 m", False)),
    can_undo=True,
    can_redo=True,
    can_recalculate=True,
    edit_settings=EditSettings(25.0, 4.0, "lower", "replace"),
)


@pytest.fixture
def panel(qtbot: QtBot, record: Recorder) -> EditPanel:
    made = EditPanel(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def test_it_shows_settings_and_edits_without_making_commands(panel: EditPanel, record: Recorder) -> None:
    assert (panel.width_m.value(), panel.magnitude_m.value()) == (25.0, 4.0)
    assert panel.operation.buttons["lower"].isChecked()
    assert panel.kind.buttons["replace"].isChecked()
    assert [panel.edits.item(row).text() for row in range(2)] == ["Raise by 8 m", "new: Lower by 2 m"]
    assert record.commands == []


def test_settings_become_commands(panel: EditPanel, record: Recorder) -> None:
    panel.width_m.setValue(30.0)
    panel.magnitude_m.setValue(5.0)
    panel.operation.buttons["raise"].click()
    panel.kind.buttons["modulate"].click()

    assert record.commands == [
        ChangeEditSettings(width=30.0),
        ChangeEditSettings(magnitude=5.0),
        ChangeEditSettings(operation="raise"),
        ChangeEditSettings(type="modulate"),
    ]


def test_buttons_and_actions_become_commands(panel: EditPanel, record: Recorder, qtbot: QtBot) -> None:
    panel.draw.click()
    panel.draw.click()
    panel.undo.trigger()
    panel.redo.trigger()
    qtbot.mouseClick(panel.recalculate_button, Qt.MouseButton.LeftButton)

    assert record.commands == [BeginEdit(), CancelEdit(), Undo(), Redo(), Recalculate()]


def test_a_line_can_be_finished_from_two_points_on(panel: EditPanel, record: Recorder) -> None:
    panel.show_status(ViewStatus(has_terrain=True, is_drawing=True, drawn_vertices=1))
    assert not panel.finish.isEnabled()
    panel.show_status(ViewStatus(has_terrain=True, is_drawing=True, drawn_vertices=2))
    panel.finish.click()

    assert record.commands == [FinishEdit()]


def test_what_is_not_possible_is_greyed(panel: EditPanel) -> None:
    panel.show_status(ViewStatus(has_terrain=True, is_recalculating=True))

    assert not panel.undo.isEnabled()
    assert not panel.redo.isEnabled()
    assert not panel.recalculate_button.isEnabled()
    assert panel.recalculate_button.text() == "Recalculating ..."


def test_the_latency_of_the_last_recalculation_is_told(panel: EditPanel) -> None:
    panel.show_status(ViewStatus(has_terrain=True, recalculate_latency_s=0.42))

    assert "0.42 s" in panel.note.text()
