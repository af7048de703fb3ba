import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import MoveSwipe
from viewer.gui.swipe_handle import SwipeHandle
from viewer.view_status import ViewStatus


@pytest.fixture
def handle(qtbot: QtBot, record: Recorder) -> SwipeHandle:
    scene = QWidget()
    scene.resize(500, 300)
    qtbot.addWidget(scene)
    made = SwipeHandle(record, scene)
    scene.show()
    qtbot.waitExposed(scene)
    made.show_status(ViewStatus(swipe_at=0.5))
    return made


def test_it_stands_on_the_divider_and_nowhere_without_one(handle: SwipeHandle) -> None:
    assert handle.isVisible()
    assert handle.geometry().center().x() == pytest.approx(250, abs=1)
    handle.parentWidget().resize(800, 300)
    handle.place()
    assert handle.geometry().center().x() == pytest.approx(400, abs=1)
    handle.show_status(ViewStatus())
    assert not handle.isVisible()


def test_dragging_moves_the_divider(handle: SwipeHandle, record: Recorder, qtbot: QtBot) -> None:
    qtbot.mousePress(handle, Qt.MouseButton.LeftButton)
    qtbot.mouseMove(handle, QPoint(13 + 100, 10))
    qtbot.waitUntil(lambda: bool(record.commands))
    moved = record.commands[-1]

    assert isinstance(moved, MoveSwipe)
    assert moved.at == pytest.approx(0.7, abs=0.02)
    assert handle.geometry().center().x() == pytest.approx(350, abs=10)


def test_the_keyboard_moves_it_too_and_not_off_the_picture(
    handle: SwipeHandle, record: Recorder, qtbot: QtBot
) -> None:
    qtbot.keyClick(handle, Qt.Key.Key_Right)
    assert record.commands == [MoveSwipe(pytest.approx(0.52))]
    for _ in range(60):
        qtbot.keyClick(handle, Qt.Key.Key_Left)
    assert record.commands[-1] == MoveSwipe(0.03)
    qtbot.keyClick(handle, Qt.Key.Key_Home)
    assert record.commands[-1] == MoveSwipe(0.5)
