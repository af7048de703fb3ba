import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialogButtonBox, QFileDialog
from pytestqt.qtbot import QtBot

from viewer.commands import SavePicture
from viewer.gui.picture_dialog import PictureDialog, ask_picture_path


def test_the_window_s_own_size_with_text_is_offered_first(qtbot: QtBot) -> None:
    dialog = PictureDialog()
    qtbot.addWidget(dialog)

    assert dialog.command == SavePicture("flood.png", None, None, True)


def test_size_text_and_file_are_what_was_chosen(qtbot: QtBot) -> None:
    dialog = PictureDialog()
    qtbot.addWidget(dialog)
    dialog.size_box.setCurrentText("3840 x 2160 (4K)")
    dialog.text.setChecked(False)
    dialog.path.setText(" here/flood 4k.png ")

    assert dialog.command == SavePicture("here/flood 4k.png", 3840.0, 2160.0, False)


def test_without_a_file_nothing_can_be_saved(qtbot: QtBot) -> None:
    dialog = PictureDialog()
    qtbot.addWidget(dialog)
    dialog.show()
    save = dialog.buttons.button(QDialogButtonBox.StandardButton.Save)
    dialog.path.setText("  ")
    assert not save.isEnabled()
    dialog.path.setText("a.png")
    with qtbot.waitSignal(dialog.accepted, timeout=1000):
        qtbot.mouseClick(save, Qt.MouseButton.LeftButton)


@pytest.mark.parametrize(
    ("chosen", "path"), [("", ""), ("a.png", "a.png"), ("a.PNG", "a.PNG"), ("a.b", "a.b.png")]
)
def test_a_picture_has_its_suffix(
    qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, chosen: str, path: str
) -> None:
    dialog = PictureDialog()
    qtbot.addWidget(dialog)
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (chosen, ""))

    assert ask_picture_path(dialog) == path
