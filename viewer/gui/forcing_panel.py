"""The forcing dock: what drives the flood from outside, what the case says, and what is changed."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QPushButton, QVBoxLayout, QWidget

from viewer.commands import Recalculate, ResetForcing
from viewer.gui.conductor import Dispatch
from viewer.gui.forcing_row import ForcingRowEditor
from viewer.view_status import ViewStatus, time_text

__all__ = ["ForcingPanel"]


class ForcingPanel(QWidget):
    """A row of fields for each item; the changes hold from the branch that Recalculate makes."""

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self.rows: list[ForcingRowEditor] = []
        self.summary = QLabel("")
        self.summary.setWordWrap(True)
        self.summary.setAccessibleName("State of the forcing")
        self.recalculate = QPushButton("Recalculate")
        self.recalculate.setObjectName("primary")
        self.recalculate.setAccessibleName("Recalculate with this forcing")
        self.recalculate.setToolTip("Branch at the time shown, with the edits and this forcing from then on")
        self.recalculate.clicked.connect(lambda: dispatch(Recalculate()))
        self.reset = QPushButton("All as the case says")
        self.reset.setAccessibleName("Take all changes of the forcing back")
        self.reset.setToolTip("Take every change of the forcing back")
        self.reset.clicked.connect(lambda: dispatch(ResetForcing()))
        self._list = QVBoxLayout()
        self._list.setSpacing(8)
        layout = QVBoxLayout(self)
        layout.addWidget(self.summary)
        layout.addWidget(self.recalculate)
        layout.addLayout(self._list)
        layout.addWidget(self.reset)
        layout.addStretch(1)
        layout.setAlignment(Qt.AlignmentFlag.AlignTop)

    def show_status(self, status: ViewStatus) -> None:
        """Show the items of the shown run."""
        if [row.item for row in self.rows] != [row.id for row in status.forcing]:
            self._rebuild(status)
        for editor, row in zip(self.rows, status.forcing, strict=True):
            editor.show_row(row, status.time)
            editor.setEnabled(status.is_connected)
        pending = sum(row.is_pending for row in status.forcing)
        if not status.forcing:
            self.summary.setText("No run is shown.")
        elif pending:
            self.summary.setText(f"{pending} changed and not recalculated yet.")
        else:
            self.summary.setText("The shown run is computed with this forcing.")
        self.reset.setEnabled(status.is_connected and any(row.is_changed for row in status.forcing))
        self.recalculate.setText(f"Recalculate from {time_text(status.time)}")
        self.recalculate.setEnabled(status.can_recalculate)

    def _rebuild(self, status: ViewStatus) -> None:
        for editor in self.rows:
            self._list.removeWidget(editor)
            editor.deleteLater()
        self.rows = [ForcingRowEditor(row, self._dispatch) for row in status.forcing]
        for editor in self.rows:
            self._list.addWidget(editor)
