import dataclasses

import pytest
from PySide6.QtWidgets import QAbstractButton, QInputDialog, QMessageBox, QPushButton
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import (
    DeleteRun,
    PauseRun,
    PinRun,
    Recalculate,
    ReleaseControl,
    RenameRun,
    ResumeRun,
    StopRun,
    TakeControl,
    UnpinRun,
)
from viewer.gui.run_actions import RunActions
from viewer.view_status import RunRow, ViewStatus

RUNNING = RunRow("r1", None, "c", "t", "running", None, 600.0, 3600.0, "cpu", moves=("pause", "stop", "pin"))
PAUSED = dataclasses.replace(RUNNING, status="paused", moves=("resume", "stop", "delete", "pin"))
STATUS = ViewStatus(
    is_connected=True, session="s1", runs=(RUNNING,), shown_run="r1", time=300.0, can_recalculate=True
)


@pytest.fixture
def actions(qtbot: QtBot, record: Recorder) -> RunActions:
    made = RunActions(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def show(actions: RunActions, row: RunRow, **more: object) -> None:
    actions.show_status(dataclasses.replace(STATUS, runs=(row,), **more))  # type: ignore[arg-type]


def enabled(actions: RunActions) -> set[str]:
    return {b.accessibleName() for b in actions.findChildren(QPushButton) if b.isEnabled()}


def test_only_what_the_status_allows_can_be_pressed(actions: RunActions) -> None:
    always = {"Branch here", "Rename", "Take control"}
    assert enabled(actions) == {"Pause", "Stop", "Pin", *always}
    show(actions, PAUSED)
    assert enabled(actions) == {"Resume", "Stop", "Delete", "Pin", *always}
    show(actions, PAUSED, is_connected=False, can_recalculate=False)
    assert enabled(actions) == set()
    actions.show_status(ViewStatus(is_connected=True))
    assert enabled(actions) == set()


def test_each_button_sends_its_command(actions: RunActions, record: Recorder) -> None:
    everything = dataclasses.replace(
        RUNNING, moves=("pause", "resume", "stop", "delete", "pin"), controller=("s1", "me"), asker="s7"
    )
    show(actions, everything)
    for button in (actions.pause, actions.resume, actions.stop, actions.branch, actions.pin):
        button.click()
    actions.hand_over.click()
    actions.release.click()
    show(actions, dataclasses.replace(RUNNING, pinned=True, moves=("unpin",)))
    assert actions.pin.text() == "Unpin"
    actions.pin.click()

    assert record.commands == [
        PauseRun(),
        ResumeRun(),
        StopRun(),
        Recalculate(),
        PinRun(),
        ReleaseControl(to="s7"),
        ReleaseControl(),
        UnpinRun(),
    ]


def test_the_branch_is_at_the_time_shown(actions: RunActions) -> None:
    assert actions.branch.text() == "Branch at 00:05:00"


def test_a_run_gets_the_name_that_is_typed_and_none_where_typing_is_given_up(
    actions: RunActions, record: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = iter([(" with the levee ", True), ("", False)])
    monkeypatch.setattr(QInputDialog, "getText", lambda *_args, **_named: next(answers))
    actions.rename.click()
    actions.rename.click()

    assert record.commands == [RenameRun("with the levee")]


def test_a_run_is_deleted_after_a_question(
    actions: RunActions, record: Recorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    show(actions, PAUSED)
    answers = iter([QMessageBox.StandardButton.No, QMessageBox.StandardButton.Yes])
    monkeypatch.setattr(QMessageBox, "question", lambda *_args: next(answers))
    actions.delete.click()
    assert record.commands == []
    actions.delete.click()

    assert record.commands == [DeleteRun()]


def test_who_controls_the_run_is_said_in_words(actions: RunActions) -> None:
    assert "Nobody controls" in actions.control.text()
    show(actions, dataclasses.replace(RUNNING, controller=("s1", "fev-viewer"), asker="s7"))
    assert actions.control.text() == "You control this run. Session s7 asks for it."
    assert {"Hand over", "Release"} <= enabled(actions)
    show(actions, dataclasses.replace(RUNNING, controller=("s2", "fev-viewer")))
    assert "fev-viewer (s2) controls this run" in actions.control.text()
    assert actions.take.text() == "Take by force"
    assert not {"Hand over", "Release"} & enabled(actions)


@pytest.mark.parametrize(
    ("pressed", "commands"),
    [("Ask", [TakeControl()]), ("Take by force", [TakeControl(force=True)]), ("Cancel", [])],
)
def test_control_of_another_is_asked_for_or_taken_by_force(
    actions: RunActions,
    record: Recorder,
    monkeypatch: pytest.MonkeyPatch,
    pressed: str,
    commands: list[TakeControl],
) -> None:
    show(actions, dataclasses.replace(RUNNING, controller=("s2", "fev-viewer")))

    def answer(box: QMessageBox) -> int:
        button: QAbstractButton = next(
            each for each in box.buttons() if each.text().replace("&", "") == pressed
        )
        button.click()
        return 0

    monkeypatch.setattr(QMessageBox, "exec", answer)
    actions.take.click()

    assert record.commands == commands


def test_control_of_nobody_is_taken_at_once(actions: RunActions, record: Recorder) -> None:
    actions.take.click()

    assert record.commands == [TakeControl()]
