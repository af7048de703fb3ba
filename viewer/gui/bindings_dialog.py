"""Keys, shortcuts and mouse as people want them."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QKeySequenceEdit,
    QLabel,
    QScrollArea,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from viewer.gui.key_names import key_name, key_sequence
from viewer.tools.bindings import DRAGS, MOTION_KEYS, SCROLLS, WHEELS, Bindings, MouseTable

__all__ = ["BindingsDialog"]

MOUSE_ROWS = {
    "left": ("Left drag", DRAGS),
    "middle": ("Middle drag", DRAGS),
    "right": ("Right drag", DRAGS),
    "shift_left": ("Shift and left drag", DRAGS),
    "wheel": ("Wheel away from you", WHEELS),
    "scroll": ("Two fingers on a trackpad", SCROLLS),
}
WORDS = {
    "orbit": "turns the view",
    "pan": "moves the ground",
    "zoom": "comes nearer or goes away",
    "nearer": "comes nearer",
    "farther": "goes away",
}


class BindingsDialog(QDialog):
    """Lets every key and the mouse be changed; nothing is taken while two things share a key.

    Args:
        bindings: the tables now.
        shortcuts: name of each menu entry to its key sequence as it came.

    Attributes:
        sequences: the field of each menu entry.
        moves: the field of each motion of the camera.
        mouse: the choice for each part of the mouse.
    """

    def __init__(
        self, bindings: Bindings, shortcuts: Mapping[str, str], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Keys and mouse")
        self._defaults = dict(shortcuts)
        self.sequences: dict[str, QKeySequenceEdit] = {}
        self.moves: dict[str, QKeySequenceEdit] = {}
        self.mouse: dict[str, QComboBox] = {}
        self.complaint = QLabel("")
        self.complaint.setWordWrap(True)
        self.complaint.setAccessibleName("Keys that clash")
        self.buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok
            | QDialogButtonBox.StandardButton.Cancel
            | QDialogButtonBox.StandardButton.RestoreDefaults
        )
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        restore = self.buttons.button(QDialogButtonBox.StandardButton.RestoreDefaults)
        restore.clicked.connect(lambda: self._show(Bindings()))
        tabs = QTabWidget()
        tabs.addTab(self._keys_tab(self.sequences, self._defaults, 4), "Menus")
        moves = {move: _words(move) for move in MOTION_KEYS.values()}
        tabs.addTab(self._keys_tab(self.moves, moves, 1), "Flying")
        tabs.addTab(self._mouse_tab(), "Mouse")
        layout = QVBoxLayout(self)
        layout.addWidget(tabs, 1)
        layout.addWidget(self.complaint)
        layout.addWidget(self.buttons)
        self.resize(460, 560)
        self._show(bindings)

    @property
    def bindings(self) -> Bindings:
        """The tables as they are filled in."""
        keys = {key_name(edit.keySequence()): move for move, edit in self.moves.items()}
        shortcuts = {
            name: text
            for name, edit in self.sequences.items()
            if (text := edit.keySequence().toString()) != self._defaults[name]
        }
        chosen = {name: str(box.currentData()) for name, box in self.mouse.items()}
        return Bindings(MouseTable(**chosen), keys, shortcuts)

    def clashes(self) -> list[str]:
        """Return a sentence for each key that two things share, and for each motion without a key."""
        users: dict[str, list[str]] = {}
        for name, edit in self.sequences.items():
            users.setdefault(edit.keySequence().toString(), []).append(name)
        for move, edit in self.moves.items():
            users.setdefault(edit.keySequence().toString(), []).append(_words(move))
        without = [_words(move) for move, edit in self.moves.items() if edit.keySequence().isEmpty()]
        return [
            f"{sequence} is used for {' and '.join(names)}."
            for sequence, names in users.items()
            if sequence and len(names) > 1
        ] + [f"{name} has no key." for name in without]

    def _keys_tab(
        self, fields: dict[str, QKeySequenceEdit], names: Mapping[str, str], longest: int
    ) -> QWidget:
        inside = QWidget()
        form = QFormLayout(inside)
        for name in names:
            edit = QKeySequenceEdit()
            edit.setMaximumSequenceLength(longest)
            edit.setClearButtonEnabled(True)
            text = name if fields is self.sequences else names[name]
            edit.setAccessibleName(text)
            edit.keySequenceChanged.connect(self._check)
            form.addRow(text, edit)
            fields[name] = edit
        scroll = QScrollArea()
        scroll.setWidget(inside)
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        return scroll

    def _mouse_tab(self) -> QWidget:
        inside = QWidget()
        form = QFormLayout(inside)
        for name, (text, allowed) in MOUSE_ROWS.items():
            box = QComboBox()
            box.setAccessibleName(text)
            for value in allowed:
                box.addItem(WORDS[value], value)
            form.addRow(text, box)
            self.mouse[name] = box
        return inside

    def _show(self, bindings: Bindings) -> None:
        for name, edit in self.sequences.items():
            edit.setKeySequence(QKeySequence(bindings.shortcuts.get(name, self._defaults[name])))
        key_of = {move: key for key, move in bindings.keys.items()}
        for move, edit in self.moves.items():
            edit.setKeySequence(key_sequence(key_of[move]))
        for name, box in self.mouse.items():
            box.setCurrentIndex(box.findData(getattr(bindings.mouse, name)))
        self._check()

    def _check(self) -> None:
        clashes = self.clashes()
        self.complaint.setText("\n".join(clashes))
        self.buttons.button(QDialogButtonBox.StandardButton.Ok).setEnabled(not clashes)


def _words(move: str) -> str:
    return move.replace("_", " ").capitalize()
