"""How a picture is to be written to a file: its size, with or without text."""

from __future__ import annotations

from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QWidget,
)

from viewer.commands import SavePicture

__all__ = ["PictureDialog", "ask_picture_path"]

SIZES: dict[str, tuple[int, int] | None] = {
    "As in the window": None,
    "1920 x 1080 (full HD)": (1920, 1080),
    "3840 x 2160 (4K)": (3840, 2160),
    "3508 x 2480 (A4 at 300 dpi)": (3508, 2480),
}


def ask_picture_path(parent: QWidget, path: str = "flood.png") -> str:
    """Return the file chosen in a native dialog, with its suffix; empty when none was."""
    chosen, _ = QFileDialog.getSaveFileName(parent, "Save picture", path, "PNG pictures (*.png)")
    return chosen if not chosen or chosen.lower().endswith(".png") else f"{chosen}.png"


class PictureDialog(QDialog):
    """Asks how to export the picture; `command` then is what was asked for."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Export picture")
        self.size_box = QComboBox()
        self.size_box.setAccessibleName("Size of the picture")
        self.size_box.addItems(list(SIZES))
        self.text = QCheckBox("Title, legend, scale bar and north arrow")
        self.text.setChecked(True)
        self.path = QLineEdit("flood.png")
        self.path.setAccessibleName("File")
        self.browse = QPushButton("Browse ...")
        self.browse.clicked.connect(self._browse)
        self.buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Save | QDialogButtonBox.StandardButton.Cancel
        )
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        save = self.buttons.button(QDialogButtonBox.StandardButton.Save)
        self.path.textChanged.connect(lambda path: save.setEnabled(bool(path.strip())))
        file = QHBoxLayout()
        file.addWidget(self.path, 1)
        file.addWidget(self.browse)
        form = QFormLayout(self)
        form.addRow("Size", self.size_box)
        form.addRow("Text", self.text)
        form.addRow("File", file)
        form.addRow(self.buttons)
        self.setMinimumWidth(460)

    @property
    def command(self) -> SavePicture:
        """What was asked for."""
        size = SIZES[self.size_box.currentText()]
        width, height = (None, None) if size is None else (float(size[0]), float(size[1]))
        return SavePicture(self.path.text().strip(), width, height, self.text.isChecked())

    def _browse(self) -> None:
        chosen = ask_picture_path(self, self.path.text())
        if chosen:
            self.path.setText(chosen)
