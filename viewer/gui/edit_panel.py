"""Draw levees, trenches and areas, select and change them, take them back, and recalculate."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QInputDialog,
    QLabel,
    QLineEdit,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from viewer.commands import (
    BeginEdit,
    BeginLevelPick,
    BeginSelect,
    CancelEdit,
    ChangeEdit,
    ChangeEditSettings,
    Command,
    DeleteEdit,
    FinishEdit,
    FlyTo,
    LoadEdits,
    Recalculate,
    Redo,
    RenameEdit,
    SaveEdits,
    SelectEdit,
    Undo,
)
from viewer.gui.conductor import Dispatch
from viewer.gui.edit_form import EditForm
from viewer.gui.edit_list_view import EditListView
from viewer.view_status import EditRow, ViewStatus, time_text

__all__ = ["EditPanel"]

_FILES = "GeoJSON (*.geojson *.json)"


class EditPanel(QWidget):
    """The terrain edit dock.

    Attributes:
        line, area, select: the tools, checked while they are in hand.
        finish, undo, redo, rename, delete, save, load, recalculate: actions, also for the window's menu.
    """

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self._status = ViewStatus()
        how = "a click sets a point, a drag draws free-hand; double click or Enter finishes, Esc drops"
        self.line = self._tool("line", "Draw line", "B", f"Draw a line: {how}", BeginEdit("line"))
        self.area = self._tool(
            "area",
            "Draw area",
            "Shift+B",
            f"Draw an area: {how}; so does a click on its first point",
            BeginEdit("area"),
        )
        self.select = self._tool(
            "select",
            "Select and move",
            "X",
            "Click an edit to select it, drag it or one of its points to move it",
            BeginSelect(),
        )
        self.finish = self._action(
            "Finish edit", None, "Take what is drawn into the list (Enter)", FinishEdit()
        )
        self.undo = self._action(
            "Undo edit", QKeySequence.StandardKey.Undo, "Take the last change back", Undo()
        )
        self.redo = self._action("Redo edit", "Ctrl+Y", "Make it again", Redo())
        self.rename = self._asking("Rename ...", "F2", "Give the selected edit a name", self._rename)
        self.delete = self._action("Delete", "Del", "Take the selected edit out of the list", DeleteEdit())
        self.save = self._asking("Save edits ...", None, "Write the list to a GeoJSON file", self._save)
        self.load = self._asking("Load edits ...", None, "Add the edits of a GeoJSON file", self._load)
        now = "Compute anew with these edits from the time shown"
        self.recalculate = self._action("Recalculate from now", "Ctrl+R", now, Recalculate())
        self.heading = QLabel("")
        self.heading.setObjectName("faint")
        self.form = EditForm(self._change, self._pick_level)
        self.edits = EditListView(
            lambda name: dispatch(SelectEdit(name)), lambda centre: dispatch(FlyTo(*centre)), self
        )
        self.edits.add_to_menu([self.rename, self.delete])
        self.recalculate_button = QPushButton("Recalculate")
        self.recalculate_button.setObjectName("primary")
        self.recalculate_button.setToolTip(f"{now} (Ctrl+R)")
        self.recalculate_button.clicked.connect(self.recalculate.trigger)
        self.note = QLabel("")
        self.note.setObjectName("faint")
        self.note.setWordWrap(True)
        self.note.setMinimumHeight(2 * self.note.fontMetrics().lineSpacing())  # nothing moves when it is said
        self._lay_out()

    def menu_actions(self) -> list[QAction | None]:
        """Return the actions for a menu; None stands for a line between two groups."""
        return [
            *(self.line, self.area, self.select, self.finish, None),
            *(self.undo, self.redo, self.rename, self.delete, None),
            *(self.save, self.load, None),
            self.recalculate,
        ]

    def show_status(self, status: ViewStatus) -> None:
        """Show the tool, its settings and the list of edits."""
        self._status = status
        self.setEnabled(status.has_terrain)
        for name, action in (("line", self.line), ("area", self.area), ("select", self.select)):
            action.setEnabled(status.has_terrain)
            action.setChecked(status.edit_tool == name)
        needed = 3 if status.edit_tool == "area" else 2
        self.finish.setEnabled(status.is_drawing and status.drawn_vertices >= needed)
        chosen = self._chosen()
        settings = status.edit_settings if chosen is None else chosen.settings
        kind = status.edit_tool if chosen is None else chosen.kind
        self.form.show_settings(
            settings, status.units, is_area=kind == "area", picks_level=status.edit_tool == "level"
        )
        self.heading.setText("Next edit" if chosen is None else f"Selected: {chosen.name or chosen.text}")
        self.edits.show_rows(status.edits, status.undone_edits, status.selected_edit)
        self.rename.setEnabled(chosen is not None)
        self.delete.setEnabled(chosen is not None)
        self.save.setEnabled(bool(status.edits))
        self.load.setEnabled(status.has_terrain)
        self.undo.setEnabled(status.can_undo)
        self.redo.setEnabled(status.can_redo)
        self.recalculate.setEnabled(status.can_recalculate)
        self.recalculate_button.setEnabled(status.can_recalculate)
        self.recalculate_button.setText(
            "Recalculating ..." if status.is_recalculating else f"Recalculate from {time_text(status.time)}"
        )
        self.note.setText(_note(status))

    def _chosen(self) -> EditRow | None:
        return next((row for row in self._status.edits if row.id == self._status.selected_edit), None)

    def _change(self, **settings: Any) -> None:
        """Change the selected edit, or what the next one will be."""
        chosen = self._chosen()
        if chosen is None:
            self._dispatch(ChangeEditSettings(**settings))
        else:
            self._dispatch(ChangeEdit(**settings, edit=chosen.id))

    def _pick_level(self) -> None:
        self._dispatch(CancelEdit() if self._status.edit_tool == "level" else BeginLevelPick())

    def _rename(self) -> None:
        chosen = self._chosen()
        if chosen is None:
            return
        name, is_given = QInputDialog.getText(
            self, "Rename the edit", "Name", QLineEdit.EchoMode.Normal, chosen.name
        )
        if is_given:
            self._dispatch(RenameEdit(name, chosen.id))

    def _save(self) -> None:
        path, _ = QFileDialog.getSaveFileName(self, "Save edits", "edits.geojson", _FILES)
        if path:
            self._dispatch(SaveEdits(path))

    def _load(self) -> None:
        path, _ = QFileDialog.getOpenFileName(self, "Load edits", "", _FILES)
        if path:
            self._dispatch(LoadEdits(path))

    def _tool(self, name: str, text: str, shortcut: str, tip: str, begin: Command) -> QAction:
        def triggered() -> None:
            self._dispatch(CancelEdit() if self._status.edit_tool == name else begin)

        action = self._asking(text, shortcut, f"{tip} ({shortcut})", triggered)
        action.setIconText(name.capitalize())
        action.setCheckable(True)
        return action

    def _action(
        self, text: str, shortcut: str | QKeySequence.StandardKey | None, tip: str, command: Command
    ) -> QAction:
        return self._asking(text, shortcut, tip, lambda: self._dispatch(command))

    def _asking(
        self,
        text: str,
        shortcut: str | QKeySequence.StandardKey | None,
        tip: str,
        asked: Callable[[], None],
    ) -> QAction:
        action = QAction(text, self)
        action.setIconText(text.removesuffix(" edit"))  # on a button among the edits
        action.setToolTip(tip)
        if shortcut is not None:
            action.setShortcut(QKeySequence(shortcut))
            action.setShortcutContext(Qt.ShortcutContext.WindowShortcut)
        action.triggered.connect(lambda: asked())
        return action

    def _lay_out(self) -> None:
        layout = QVBoxLayout(self)
        layout.addLayout(_buttons(self.line, self.area, self.select, self.finish))
        layout.addWidget(self.heading)
        layout.addWidget(self.form)
        layout.addWidget(self.edits, 1)
        layout.addLayout(_buttons(self.undo, self.redo, self.delete))
        layout.addLayout(_buttons(self.rename, self.save, self.load))
        layout.addWidget(self.recalculate_button)
        layout.addWidget(self.note)


def _buttons(*actions: QAction) -> QHBoxLayout:
    row = QHBoxLayout()
    for action in actions:
        button = QToolButton()
        button.setDefaultAction(action)
        button.setAccessibleName(action.text())
        row.addWidget(button)
    row.addStretch(1)
    return row


def _note(status: ViewStatus) -> str:
    match status.edit_tool:
        case "line" | "area":
            drawn = status.drawn_vertices
            if drawn == 0:
                return "Click the ground to set points, or drag to draw free-hand."
            return f"{drawn} points; Enter finishes, Backspace drops the last, Esc drops all."
        case "select":
            return "Click an edit; drag it or one of its points. Del deletes, F2 renames, Esc ends."
        case "level":
            return "Click on water or ground to take its level."
    if status.recalculate_latency_s is not None:
        return f"First changed frame {status.recalculate_latency_s:.2f} s after Recalculate."
    return ""
