from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QPointF, QSettings, Qt
from PySide6.QtGui import QKeySequence, QWheelEvent
from PySide6.QtWidgets import QApplication, QDialog, QDialogButtonBox
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import OpenWindow
from viewer.gui.bindings_dialog import BindingsDialog
from viewer.gui.kept_settings import KeptSettings
from viewer.tools import Bindings, MouseTable

SHORTCUTS = {"Save picture": "Ctrl+S", "Quit": "Ctrl+Q", "Whole terrain": "R"}


@pytest.fixture
def dialog(qtbot: QtBot) -> BindingsDialog:
    made = BindingsDialog(Bindings(MouseTable(wheel="farther"), shortcuts={"Quit": "Ctrl+X"}), SHORTCUTS)
    qtbot.addWidget(made)
    return made


def is_allowed(dialog: BindingsDialog) -> bool:
    return dialog.buttons.button(QDialogButtonBox.StandardButton.Ok).isEnabled()


def test_it_shows_the_tables_and_gives_them_back(dialog: BindingsDialog) -> None:
    assert dialog.sequences["Quit"].keySequence().toString() == "Ctrl+X"
    assert dialog.moves["pan_forward"].keySequence().toString() == "W"
    assert dialog.bindings == Bindings(MouseTable(wheel="farther"), shortcuts={"Quit": "Ctrl+X"})
    assert is_allowed(dialog)


def test_two_things_cannot_share_a_key_nor_a_motion_be_without_one(dialog: BindingsDialog) -> None:
    dialog.sequences["Whole terrain"].setKeySequence(QKeySequence("W"))
    assert "W is used for Whole terrain and Pan forward." in dialog.complaint.text()
    assert not is_allowed(dialog)
    dialog.moves["pan_forward"].setKeySequence(QKeySequence("I"))
    assert is_allowed(dialog)
    dialog.moves["pan_back"].clear()
    assert "Pan back has no key." in dialog.complaint.text()
    assert not is_allowed(dialog)


def test_the_tables_can_be_put_back_as_they_came(dialog: BindingsDialog) -> None:
    dialog.buttons.button(QDialogButtonBox.StandardButton.RestoreDefaults).click()

    assert dialog.bindings == Bindings()


def test_the_window_obeys_the_tables_and_remembers_them(
    opened: OpenWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    window = opened.window
    store = str(tmp_path / "viewer.ini")
    window._kept = KeptSettings(QSettings(store, QSettings.Format.IniFormat))

    def accept(dialog: BindingsDialog) -> int:
        dialog.sequences["Wireframe"].setKeySequence(QKeySequence("Ctrl+W"))
        dialog.moves["zoom_in"].setKeySequence(QKeySequence("P"))
        dialog.mouse["wheel"].setCurrentIndex(1)
        assert dialog.clashes() == []
        return QDialog.DialogCode.Accepted

    monkeypatch.setattr(BindingsDialog, "exec", accept)
    window._change_bindings()
    assert opened.app.camera_work is not None
    before = opened.app.camera_work.camera.distance
    wheel(opened, 120)
    opened.until(lambda: distance(opened) > before)
    opened.bot.waitUntil(lambda: not opened.app.camera_work.is_moving, timeout=5000)  # type: ignore[union-attr]
    before = distance(opened)
    opened.bot.keyPress(window.scene, Qt.Key.Key_P)
    opened.until(lambda: distance(opened) < before)
    opened.bot.keyRelease(window.scene, Qt.Key.Key_P)
    opened.bot.keyClick(window, Qt.Key.Key_W, Qt.KeyboardModifier.ControlModifier)
    opened.until(lambda: opened.app.options.wireframe)

    kept = KeptSettings(QSettings(store, QSettings.Format.IniFormat)).bindings()
    assert kept == window._bindings
    assert kept.keys["p"] == "zoom_in"


def test_two_fingers_on_a_trackpad_move_the_ground(opened: OpenWindow) -> None:
    assert opened.app.camera_work is not None
    before = opened.app.camera_work.camera.target
    for phase, dx in (
        (Qt.ScrollPhase.ScrollBegin, 0),
        (Qt.ScrollPhase.ScrollUpdate, 40),
        (Qt.ScrollPhase.ScrollUpdate, 40),
    ):
        wheel(opened, 0, dx, phase)
    opened.until(lambda: opened.app.camera_work.camera.target != before)  # type: ignore[union-attr]
    wheel(opened, 0, 0, Qt.ScrollPhase.ScrollEnd)
    distance_before = distance(opened)

    assert distance(opened) == distance_before


def distance(opened: OpenWindow) -> float:
    assert opened.app.camera_work is not None
    return opened.app.camera_work.camera.distance


def wheel(
    opened: OpenWindow, notches: int, dx: int = 0, phase: Qt.ScrollPhase = Qt.ScrollPhase.NoScrollPhase
) -> None:
    scene = opened.window.scene
    at = QPointF(scene.width() / 2, scene.height() / 2)
    event = QWheelEvent(
        at,
        scene.mapToGlobal(at),
        QPoint(dx, 0),
        QPoint(0, notches),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        phase,
        False,
    )
    QApplication.sendEvent(scene, event)
