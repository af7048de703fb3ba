"""The run dock: start a run; see the tree of runs and branches; steer and compare the shown one."""

from __future__ import annotations

from PySide6.QtWidgets import QComboBox, QFormLayout, QTabWidget, QVBoxLayout, QWidget

from viewer.commands import CompareWith
from viewer.gui.conductor import Dispatch
from viewer.gui.run_actions import RunActions
from viewer.gui.run_start_form import RunStartForm
from viewer.gui.run_tree_view import RunTreeView, run_name
from viewer.view_status import ViewStatus

__all__ = ["RunPanel"]


class RunPanel(QWidget):
    """The run dock."""

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self.starting = RunStartForm(dispatch)
        self.tree = RunTreeView(dispatch)
        self.actions_of_run = RunActions(dispatch)
        self.compare = QComboBox()
        self.compare.setAccessibleName("Compare with")
        self.compare.setToolTip("Colour the picture by how much deeper or shallower the water is than there")
        self.compare.activated.connect(lambda _row: self._compare())
        self.compare_mode = QComboBox()
        self.compare_mode.setAccessibleName("Compare by")
        self.compare_mode.setToolTip("Colour the difference, or show the other run right of a divider")
        self.compare_mode.addItem("by difference", "difference")
        self.compare_mode.addItem("side by side", "swipe")
        self.compare_mode.activated.connect(lambda _row: self._compare())
        self.pages = QTabWidget()
        self.pages.setAccessibleName("Runs, or a new run")
        self.pages.setDocumentMode(True)
        present = QWidget()
        layout = QVBoxLayout(present)
        layout.setContentsMargins(0, 4, 0, 0)
        layout.addWidget(self.tree, 1)
        layout.addWidget(self.actions_of_run)
        comparing = QFormLayout()
        comparing.addRow("Compare with", self.compare)
        comparing.addRow("", self.compare_mode)
        layout.addLayout(comparing)
        new = QWidget()
        starting = QVBoxLayout(new)
        starting.setContentsMargins(0, 4, 0, 0)
        starting.addWidget(self.starting)
        starting.addStretch(1)
        self.pages.addTab(new, "New run")
        self.pages.addTab(present, "Runs")
        outer = QVBoxLayout(self)
        outer.addWidget(self.pages)
        self._shown: str | None = None

    def show_status(self, status: ViewStatus) -> None:
        """Show the cases, the devices, the tree of runs and what can be done."""
        self.starting.show_status(status)
        self.tree.show_status(status)
        self.actions_of_run.show_status(status)
        self._show_comparison(status)
        if status.shown_run != self._shown:  # another run on the picture is what to look at now
            self._shown = status.shown_run
            self.pages.setCurrentIndex(0 if self._shown is None else 1)

    def _show_comparison(self, status: ViewStatus) -> None:
        shown = next((row for row in status.runs if row.run == status.shown_run), None)
        others = [] if shown is None else [row for row in status.runs if row.case == shown.case]
        choices: list[tuple[str, str | None]] = [("nothing", None)]
        choices += [(run_name(row), row.run) for row in others if row is not shown]
        box = self.compare
        if choices != [(box.itemText(k), box.itemData(k)) for k in range(box.count())]:
            self.compare.clear()
            for text, run in choices:
                self.compare.addItem(text, run)
        self.compare.setCurrentIndex(max(0, self.compare.findData(status.compared_run)))
        self.compare.setEnabled(len(choices) > 1)
        self.compare_mode.setEnabled(len(choices) > 1)
        if status.compared_run is not None:
            self.compare_mode.setCurrentIndex(max(0, self.compare_mode.findData(status.compare_mode)))

    def _compare(self) -> None:
        self._dispatch(CompareWith(self.compare.currentData(), self.compare_mode.currentData()))
