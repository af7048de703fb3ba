"""Draw levees and trenches, take them back, and recalculate."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QColor, QKeySequence
from PySide6.QtWidgets import (
    QButtonGroup,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from viewer.commands import BeginEdit, CancelEdit, ChangeEditSettings, FinishEdit, Recalculate, Redo, Undo
from viewer.gui.conductor import Dispatch
from viewer.gui.theme import BRANCH
from viewer.view_status import EditRow, ViewStatus, time_text

__all__ = ["EditPanel"]


class EditPanel(QWidget):
    """The terrain edit dock.

    Attributes:
        undo, redo, recalculate: actions, also for the window's menu.
    """

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self.draw = QPushButton("Draw edit line")
        self.draw.setCheckable(True)
        self.draw.setToolTip(
            "Click points on the ground; double click or Enter finishes, Esc drops the line (B)"
        )
        self.draw.clicked.connect(lambda on: dispatch(BeginEdit() if on else CancelEdit()))
        self.finish = QPushButton("Finish line")
        self.finish.setToolTip("Take the drawn line into the list (Enter)")
        self.finish.clicked.connect(lambda: dispatch(FinishEdit()))
        self.width_m = self._number("Width", 1.0, 1000.0, " m", lambda value: ChangeEditSettings(width=value))
        self.magnitude_m = self._number(
            "Magnitude", 0.1, 200.0, " m", lambda value: ChangeEditSettings(magnitude=value)
        )
        self.operation = _Choice(
            "Operation",
            {"raise": ("Raise", "A levee: lift the ground"), "lower": ("Lower", "A trench: cut the ground")},
            lambda name: dispatch(ChangeEditSettings(operation=name)),
        )
        self.kind = _Choice(
            "Type",
            {
                "modulate": ("Follow ground", "Modulate: add the magnitude to the ground as it is"),
                "replace": ("Straight crest", "Replace: an even crest or floor between the drawn points"),
            },
            lambda name: dispatch(ChangeEditSettings(type=name)),
        )
        self.edits = QListWidget()
        self.edits.setAccessibleName("Edits")
        self.edits.setToolTip("Edits of the shown run; a new one counts from the next Recalculate on")
        self.edits.setMinimumHeight(60)
        self.edits.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
        self.edits.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.edits.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.undo = self._action("Undo edit", QKeySequence.StandardKey.Undo, Undo())
        self.redo = self._action("Redo edit", QKeySequence("Ctrl+Y"), Redo())
        self.recalculate = self._action("Recalculate from now", QKeySequence("Ctrl+R"), Recalculate())
        self.recalculate_button = QPushButton("Recalculate")
        self.recalculate_button.setObjectName("primary")
        self.recalculate_button.setToolTip("Compute anew with these edits from the time shown (Ctrl+R)")
        self.recalculate_button.clicked.connect(self.recalculate.trigger)
        self.note = QLabel("")
        self.note.setObjectName("faint")
        self.note.setWordWrap(True)
        self._lay_out()

    def show_status(self, status: ViewStatus) -> None:
        """Show the tool, its settings and the list of edits."""
        self.setEnabled(status.has_terrain)
        self.draw.setChecked(status.is_drawing)
        self.finish.setEnabled(status.is_drawing and status.drawn_vertices >= 2)
        settings = status.edit_settings
        for box, value in ((self.width_m, settings.width), (self.magnitude_m, settings.magnitude)):
            if not box.hasFocus():
                blocked = box.blockSignals(True)
                box.setValue(value)
                box.blockSignals(blocked)
        self.operation.show_choice(settings.operation)
        self.kind.show_choice(settings.type)
        texts = [_row_text(row) for row in status.edits]
        if texts != [self.edits.item(row).text() for row in range(self.edits.count())]:
            self.edits.clear()
            for text, row in zip(texts, status.edits, strict=True):
                item = QListWidgetItem(text, self.edits)
                if row.warning:
                    item.setForeground(QColor(BRANCH))
        self.undo.setEnabled(status.can_undo)
        self.redo.setEnabled(status.can_redo)
        self.recalculate.setEnabled(status.can_recalculate)
        self.recalculate_button.setEnabled(status.can_recalculate)
        self.recalculate_button.setText(
            "Recalculating ..." if status.is_recalculating else f"Recalculate from {time_text(status.time)}"
        )
        self.note.setText(_note(status))

    def _number(self, name: str, low: float, high: float, suffix: str, command: object) -> QDoubleSpinBox:
        box = QDoubleSpinBox()
        box.setAccessibleName(name)
        box.setRange(low, high)
        box.setDecimals(1)
        box.setSuffix(suffix)
        box.setKeyboardTracking(False)
        assert callable(command)
        box.valueChanged.connect(lambda value: self._dispatch(command(value)))
        return box

    def _action(
        self, text: str, shortcut: QKeySequence | QKeySequence.StandardKey, command: object
    ) -> QAction:
        action = QAction(text, self)
        action.setShortcut(QKeySequence(shortcut))
        action.setShortcutContext(Qt.ShortcutContext.WindowShortcut)
        action.triggered.connect(lambda: self._dispatch(command))  # type: ignore[arg-type]
        return action

    def _lay_out(self) -> None:
        drawing = QHBoxLayout()
        drawing.addWidget(self.draw)
        drawing.addWidget(self.finish)
        form = QFormLayout()
        form.addRow("Width", self.width_m)
        form.addRow("Magnitude", self.magnitude_m)
        form.addRow("Operation", self.operation)
        form.addRow("Type", self.kind)
        history = QHBoxLayout()
        for action in (self.undo, self.redo):
            button = QToolButton()
            button.setDefaultAction(action)
            history.addWidget(button)
        history.addStretch(1)
        layout = QVBoxLayout(self)
        layout.addLayout(drawing)
        layout.addLayout(form)
        layout.addWidget(self.edits, 1)
        layout.addLayout(history)
        layout.addWidget(self.recalculate_button)
        layout.addWidget(self.note)


class _Choice(QWidget):
    """Two or more exclusive buttons side by side."""

    def __init__(self, name: str, choices: dict[str, tuple[str, str]], chosen: object) -> None:
        super().__init__()
        assert callable(chosen)
        self.buttons: dict[str, QPushButton] = {}
        group = QButtonGroup(self)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        for key, (label, tip) in choices.items():
            button = QPushButton(label)
            button.setCheckable(True)
            button.setToolTip(tip)
            button.setAccessibleName(f"{name}: {label}")
            button.clicked.connect(lambda _on, key=key: chosen(key))
            group.addButton(button)
            layout.addWidget(button)
            self.buttons[key] = button

    def show_choice(self, key: str) -> None:
        """Press the button of `key`."""
        if key in self.buttons:
            self.buttons[key].setChecked(True)


def _row_text(row: EditRow) -> str:
    first = f"{'' if row.is_applied else 'new: '}{row.text}"
    return "\n".join(line for line in (first, row.measure, row.warning) if line)


def _note(status: ViewStatus) -> str:
    if status.is_drawing:
        drawn = status.drawn_vertices
        return (
            "Click the ground to set points." if drawn == 0 else f"{drawn} points; Enter finishes, Esc drops."
        )
    if status.recalculate_latency_s is not None:
        return f"First changed frame {status.recalculate_latency_s:.2f} s after Recalculate."
    return ""
