import dataclasses

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import ChangeForcing, ResetForcing
from viewer.gui.forcing_row import ForcingRowEditor
from viewer.view_status import ForcingRow

SPRING = ForcingRow("spring", "source", "m3/s", "5 m3/s")
SEA = ForcingRow("sea", "stage", "m", "1.5 m")
DAM = ForcingRow("dam", "breach", "s", "at 00:05:00", case_start=300.0)


def editor(qtbot: QtBot, record: Recorder, row: ForcingRow) -> ForcingRowEditor:
    made = ForcingRowEditor(row, record)
    qtbot.addWidget(made)
    made.show()
    made.show_row(row, 125.0)
    return made


def test_showing_a_row_changes_nothing(qtbot: QtBot, record: Recorder) -> None:
    for row in (SPRING, SEA, DAM):
        made = editor(qtbot, record, row)
        made.show_row(dataclasses.replace(row, factor=2.0, offset=0.3, start=600.0, is_changed=True), 130.0)

    assert record.commands == []


def test_a_factor_that_is_typed_or_stepped_is_sent(qtbot: QtBot, record: Recorder) -> None:
    made = editor(qtbot, record, SPRING)
    made.factor.selectAll()
    qtbot.keyClicks(made.factor, "2.5")
    assert record.commands == []
    qtbot.keyClick(made.factor, Qt.Key.Key_Return)
    made.factor.stepUp()

    assert record.commands == [
        ChangeForcing("spring", factor=2.5),
        ChangeForcing("spring", factor=pytest.approx(2.6)),  # type: ignore[arg-type]
    ]


def test_a_level_is_raised(qtbot: QtBot, record: Recorder) -> None:
    made = editor(qtbot, record, SEA)
    made.offset.setValue(0.5)

    assert record.commands == [ChangeForcing("sea", offset=0.5)]


def test_a_series_is_loaded_from_the_file_that_is_chosen(
    qtbot: QtBot, record: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = editor(qtbot, record, SPRING)
    answers = iter([("/data/q.csv", ""), ("", "")])
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_args: next(answers))
    made.load.click()
    made.load.click()

    assert record.commands == [ChangeForcing("spring", series_file="/data/q.csv")]


def test_a_breach_begins_at_a_time_or_now_or_never_or_as_the_case_says(
    qtbot: QtBot, record: Recorder
) -> None:
    made = editor(qtbot, record, DAM)
    assert made.start_min.value() == 5.0
    assert not made.start_min.isEnabled()
    for choice in (2, 1, 0):
        made.choice.setCurrentIndex(choice)
        made.choice.activated.emit(choice)
    made.now.click()
    made.show_row(dataclasses.replace(DAM, start=125.0, is_changed=True), 125.0)
    assert made.start_min.isEnabled()
    made.start_min.setValue(10.0)

    assert record.commands == [
        ChangeForcing("dam", start="never"),
        ChangeForcing("dam", start=300.0),
        ChangeForcing("dam", start="case"),
        ChangeForcing("dam", start=125.0),
        ChangeForcing("dam", start=600.0),
    ]


def test_what_is_changed_is_marked_and_can_be_taken_back(qtbot: QtBot, record: Recorder) -> None:
    made = editor(qtbot, record, SPRING)
    assert not made.reset.isEnabled()
    made.show_row(dataclasses.replace(SPRING, factor=2.0, is_changed=True, is_pending=True), 0.0)
    assert "not recalculated" in made.title.text()
    made.show_row(
        dataclasses.replace(SPRING, series_text="1 to 9 m3/s", is_changed=True, is_pending=False), 0.0
    )
    assert "(changed)" in made.title.text()
    assert "changed to 1 to 9 m3/s" in made.case_text.text()
    made.reset.click()

    assert record.commands == [ResetForcing("spring")]


def test_a_factor_of_nothing_cannot_be_given(qtbot: QtBot, record: Recorder) -> None:
    none = ForcingRow("rain", "rain", "mm/h", "none")
    made = editor(qtbot, record, none)
    assert not made.factor.isEnabled()
    made.show_row(dataclasses.replace(none, series_text="5 mm/h", is_changed=True), 0.0)
    assert made.factor.isEnabled()
