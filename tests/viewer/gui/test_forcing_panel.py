import dataclasses

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

import protocol
from tests.viewer.gui.conftest import OpenWindow, Recorder
from viewer.commands import Recalculate, ResetForcing
from viewer.gui.forcing_panel import ForcingPanel
from viewer.view_status import ForcingRow, ViewStatus

SPRING = ForcingRow("spring", "source", "m3/s", "5 m3/s")
DAM = ForcingRow("dam", "breach", "s", "at 00:05:00", case_start=300.0)
STATUS = ViewStatus(is_connected=True, forcing=(SPRING, DAM), time=65.0, can_recalculate=True)


@pytest.fixture
def panel(qtbot: QtBot, record: Recorder) -> ForcingPanel:
    made = ForcingPanel(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def test_every_item_has_its_row_and_keeps_it(panel: ForcingPanel) -> None:
    rows = list(panel.rows)
    assert [row.item for row in rows] == ["spring", "dam"]
    panel.show_status(dataclasses.replace(STATUS, forcing=(dataclasses.replace(SPRING, factor=2.0), DAM)))
    assert panel.rows == rows
    assert rows[0].factor.value() == 2.0
    panel.show_status(dataclasses.replace(STATUS, forcing=(DAM,)))
    assert [row.item for row in panel.rows] == ["dam"]


def test_what_is_not_recalculated_yet_is_counted_and_computed_by_one_button(
    panel: ForcingPanel, record: Recorder
) -> None:
    assert "is computed with this forcing" in panel.summary.text()
    assert not panel.reset.isEnabled()
    changed = dataclasses.replace(SPRING, factor=2.0, is_changed=True, is_pending=True)
    panel.show_status(dataclasses.replace(STATUS, forcing=(changed, DAM)))
    assert panel.summary.text() == "1 changed and not recalculated yet."
    assert panel.recalculate.text() == "Recalculate from 00:01:05"
    panel.recalculate.click()
    panel.reset.click()

    assert record.commands == [Recalculate(), ResetForcing()]


def test_nothing_can_be_changed_without_a_service_or_a_run(panel: ForcingPanel) -> None:
    panel.show_status(dataclasses.replace(STATUS, is_connected=False, can_recalculate=False))
    assert not any(row.isEnabled() for row in panel.rows)
    assert not panel.recalculate.isEnabled()
    panel.show_status(ViewStatus())
    assert panel.rows == []
    assert panel.summary.text() == "No run is shown."


def test_a_factor_typed_in_the_window_drives_the_branch(opened: OpenWindow) -> None:
    panel, bot = opened.window.forcing_panel, opened.bot
    opened.until(lambda: len(panel.rows) == 4)
    next(dock for dock in opened.window.docks if dock.windowTitle() == "Forcing").raise_()
    opened.until(panel.rows[0].factor.isVisible)
    box = panel.rows[0].factor
    box.setFocus()
    box.selectAll()
    bot.keyClicks(box, "2.5")
    bot.keyClick(box, Qt.Key.Key_Return)
    opened.until(lambda: "1 changed" in panel.summary.text())
    bot.mouseClick(panel.recalculate, Qt.MouseButton.LeftButton)
    opened.until(lambda: opened.app.shown is not None and opened.app.shown.run == "run-2")
    assert opened.service.runs["run-2"].applied == (protocol.ForcingChange("spring", 2.5),)
    opened.until(lambda: "is computed with this forcing" in panel.summary.text())
