import dataclasses

import pytest
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import CompareWith, PauseRun, ResumeRun, SelectRun, StartRun, StopRun
from viewer.gui.run_panel import RunPanel
from viewer.view_status import CaseRow, RunRow, ViewStatus

CASES = (
    CaseRow("jacksboro", "A dam break", 3600.0, 20.0, 547_479, True),
    CaseRow("malpasset", "The 1959 disaster", 4000.0, 20.0, 705_000, False),
)
ROOT = RunRow("r1", None, "jacksboro", "A dam break", "paused", None, 600.0, 3600.0, "cpu")
CHILD = RunRow("r2", "r1", "jacksboro", "A dam break", "running", 300.0, 400.0, 3600.0, "cpu")
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


def test_a_case_brings_its_own_duration_and_interval(panel: RunPanel) -> None:
    panel.choose_case("malpasset")

    assert panel.duration_min.value() == pytest.approx(4000.0 / 60.0, abs=0.1)
    assert panel.interval_s.value() == 20.0
    assert "705,000 cells" in panel.about.text()


def test_start_sends_what_is_chosen(panel: RunPanel, record: Recorder) -> None:
    panel.choose_case("jacksboro")
    panel.duration_min.setValue(30.0)
    panel.interval_s.setValue(10.0)
    panel.device.setCurrentText("cuda:0")
    panel.start.click()

    assert record.commands == [StartRun("jacksboro", 1800.0, 10.0, "cuda:0")]


def test_runs_stand_as_a_tree_with_the_shown_one_marked(panel: RunPanel) -> None:
    root = panel.tree.topLevelItem(0)

    assert panel.tree.topLevelItemCount() == 1
    assert root is not None
    assert root.text(0) == "jacksboro"
    assert root.child(0).text(0) == "from 00:05:00"
    assert root.child(0).font(0).bold()
    assert not root.font(0).bold()


def test_a_click_on_a_run_shows_it(panel: RunPanel, record: Recorder) -> None:
    root = panel.tree.topLevelItem(0)
    panel.tree.itemClicked.emit(root, 0)

    assert record.commands == [SelectRun("r1")]


def test_a_run_that_is_gone_leaves_the_tree(panel: RunPanel) -> None:
    panel.show_status(ViewStatus(is_connected=True, cases=CASES, runs=(ROOT,), shown_run="r1"))
    root = panel.tree.topLevelItem(0)

    assert root is not None
    assert root.childCount() == 0


def test_a_branch_known_before_its_parent_still_appears(panel: RunPanel) -> None:
    panel.show_status(ViewStatus(runs=(CHILD,)))

    assert panel.tree.topLevelItemCount() == 1


def test_pause_resume_and_stop_fit_the_state_of_the_run(panel: RunPanel, record: Recorder) -> None:
    assert (panel.pause.isEnabled(), panel.resume.isEnabled(), panel.stop.isEnabled()) == (True, False, True)
    panel.pause.click()
    panel.stop.click()
    panel.show_status(ViewStatus(is_connected=True, cases=CASES, runs=(ROOT,), shown_run="r1"))
    assert (panel.pause.isEnabled(), panel.resume.isEnabled(), panel.stop.isEnabled()) == (False, True, True)
    panel.resume.click()

    assert record.commands == [PauseRun(), StopRun(), ResumeRun()]


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
