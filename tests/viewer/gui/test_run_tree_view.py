import dataclasses

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import SelectRun
from viewer.gui.run_tree_view import RunTreeView, run_name
from viewer.view_status import RunRow, ViewStatus

ROOT = RunRow("r1", None, "jacksboro", "A dam break", "paused", None, 600.0, 3600.0, "cpu")
CHILD = RunRow("r2", "r1", "jacksboro", "A dam break", "running", 300.0, 400.0, 3600.0, "cpu")
STATUS = ViewStatus(is_connected=True, runs=(ROOT, CHILD), shown_run="r2")


@pytest.fixture
def tree(qtbot: QtBot, record: Recorder) -> RunTreeView:
    made = RunTreeView(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def test_runs_stand_as_a_tree_with_the_shown_one_marked(tree: RunTreeView) -> None:
    root = tree.topLevelItem(0)

    assert tree.topLevelItemCount() == 1
    assert root is not None
    assert root.text(0) == "jacksboro"
    assert root.child(0).text(0) == "from 00:05:00"
    assert root.child(0).font(0).bold()
    assert not root.font(0).bold()


def test_a_click_and_the_return_key_on_a_run_show_it(
    tree: RunTreeView, record: Recorder, qtbot: QtBot
) -> None:
    root = tree.topLevelItem(0)
    qtbot.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=tree.visualItemRect(root).center())
    assert record.commands == [SelectRun("r1")]
    qtbot.keyClick(tree, Qt.Key.Key_Return)
    assert record.commands == [SelectRun("r1")] * 2


def test_a_run_that_is_gone_leaves_the_tree(tree: RunTreeView) -> None:
    tree.show_status(ViewStatus(is_connected=True, runs=(ROOT,), shown_run="r1"))
    root = tree.topLevelItem(0)

    assert root is not None
    assert root.childCount() == 0


def test_a_branch_known_before_its_parent_still_appears(tree: RunTreeView) -> None:
    tree.show_status(ViewStatus(runs=(CHILD,)))

    assert tree.topLevelItemCount() == 1


def test_a_name_a_pin_and_who_controls_it_are_shown(tree: RunTreeView) -> None:
    named = dataclasses.replace(ROOT, label="with the levee", pinned=True, controller=("s9", "fev-viewer"))
    tree.show_status(dataclasses.replace(STATUS, runs=(named, CHILD)))
    root = tree.topLevelItem(0)

    assert root is not None
    assert root.text(0) == "with the levee (pinned)"
    assert "controlled by fev-viewer s9" in root.toolTip(0)
    assert run_name(named) == "with the levee from the start (r1)"
