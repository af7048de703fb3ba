import dataclasses

import pytest
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import CompareWith, PauseRun
from viewer.gui.run_panel import RunPanel
from viewer.view_status import CaseRow, RunRow, ViewStatus

CASES = (
    CaseRow("jacksboro", "A dam break", 3600.0, 20.0, 547_479, True),
    CaseRow("malpasset", "The 1959 disaster", 4000.0, 20.0, 705_000, False),
)
ROOT = RunRow("r1", None, "jacksboro", "A dam break", "paused", None, 600.0, 3600.0, "cpu")
CHILD = RunRow(
    "r2", "r1", "jacksboro", "A dam break", "running", 300.0, 400.0, 3600.0, "cpu", moves=("pause", "stop")
)
STATUS = ViewStatus(
    is_connected=True, cases=CASES, runs=(ROOT, CHILD), shown_run="r2", devices=("cpu", "cuda:0")
)


@pytest.fixture
def panel(qtbot: QtBot, record: Recorder) -> RunPanel:
    made = RunPanel(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def test_a_new_run_is_offered_until_one_is_shown(panel: RunPanel) -> None:
    assert panel.tree.isVisible()
    assert not panel.starting.isVisible()
    panel.show_status(dataclasses.replace(STATUS, shown_run=None))
    assert panel.starting.isVisible()
    panel.show_status(STATUS)
    panel.pages.setCurrentIndex(0)
    panel.show_status(dataclasses.replace(STATUS, time=10.0))
    assert panel.starting.isVisible()


def test_its_parts_show_the_same_status(panel: RunPanel, record: Recorder) -> None:
    assert panel.starting.case.count() == 2
    assert panel.tree.topLevelItemCount() == 1
    assert panel.actions_of_run.pause.isEnabled()
    panel.actions_of_run.pause.click()

    assert record.commands == [PauseRun()]


def test_the_other_runs_of_the_case_can_be_compared_with(panel: RunPanel, record: Recorder) -> None:
    texts = [panel.compare.itemText(row) for row in range(panel.compare.count())]
    assert texts == ["nothing", "jacksboro from the start (r1)"]
    panel.compare.setCurrentIndex(1)
    panel.compare.activated.emit(1)
    panel.compare_mode.setCurrentIndex(1)
    panel.compare_mode.activated.emit(1)
    panel.compare.setCurrentIndex(0)
    panel.compare.activated.emit(0)

    assert record.commands == [CompareWith("r1"), CompareWith("r1", "swipe"), CompareWith(None, "swipe")]
    panel.show_status(dataclasses.replace(STATUS, compared_run="r1"))
    assert panel.compare.currentIndex() == 1
    panel.show_status(dataclasses.replace(STATUS, runs=(ROOT,), shown_run="r1"))
    assert not panel.compare.isEnabled()
