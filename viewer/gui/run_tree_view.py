"""The tree of runs and branches, with the shown one marked."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHeaderView, QSizePolicy, QTreeWidget, QTreeWidgetItem, QWidget

from viewer.commands import SelectRun
from viewer.gui.conductor import Dispatch
from viewer.view_status import RunRow, ViewStatus, time_text

__all__ = ["RunTreeView", "run_name"]

RUN_ROLE = Qt.ItemDataRole.UserRole


class RunTreeView(QTreeWidget):
    """Runs by their parents; a click or Return shows one."""

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._runs: tuple[RunRow, ...] = ()
        self.setAccessibleName("Runs and branches")
        self.setToolTip("Click a run to show it")
        self.setHeaderLabels(["Run", "Computed", "State"])
        self.setRootIsDecorated(True)
        self.setIndentation(14)
        self.setMinimumHeight(96)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.header().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.header().setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.header().setSectionResizeMode(2, QHeaderView.ResizeMode.ResizeToContents)
        self.header().setStretchLastSection(False)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.itemClicked.connect(lambda item: dispatch(SelectRun(item.data(0, RUN_ROLE))))
        self.itemActivated.connect(lambda item: dispatch(SelectRun(item.data(0, RUN_ROLE))))

    def show_status(self, status: ViewStatus) -> None:
        """Show the runs."""
        if status.runs != self._runs:
            self._runs = status.runs
            self._show_runs(status.runs)
        for item in self.items():
            font = item.font(0)
            font.setBold(item.data(0, RUN_ROLE) == status.shown_run)
            item.setFont(0, font)
            if item.data(0, RUN_ROLE) == status.shown_run and not self.hasFocus():
                self.setCurrentItem(item)

    def items(self) -> list[QTreeWidgetItem]:
        """Every item, whatever its depth."""
        found: list[QTreeWidgetItem] = []
        pending = [self.topLevelItem(row) for row in range(self.topLevelItemCount())]
        while pending:
            item = pending.pop()
            if item is not None:
                found.append(item)
                pending.extend(item.child(row) for row in range(item.childCount()))
        return found

    def _show_runs(self, runs: tuple[RunRow, ...]) -> None:
        known = {item.data(0, RUN_ROLE): item for item in self.items()}
        if set(known) - {row.run for row in runs}:
            self.clear()
            known = {}
        pending = list(runs)
        while pending:
            placeable = [row for row in pending if row.parent is None or row.parent in known] or pending
            for row in placeable:
                item = known.get(row.run)
                if item is None:
                    parent = known.get(row.parent or "")
                    item = QTreeWidgetItem(self) if parent is None else QTreeWidgetItem(parent)
                    item.setData(0, RUN_ROLE, row.run)
                    known[row.run] = item
                    item.setExpanded(True)
                    if parent is not None:
                        parent.setExpanded(True)
                _fill(item, row)
            pending = [row for row in pending if row.run not in known]


def _fill(item: QTreeWidgetItem, row: RunRow) -> None:
    label = row.label or (row.case if row.branch_time is None else f"from {time_text(row.branch_time)}")
    item.setText(0, f"{label} (pinned)" if row.pinned else label)
    session, client = row.controller
    controlled = f", controlled by {client or 'session'} {session}" if session else ""
    item.setToolTip(0, f"{row.title} ({row.run}) on {row.device}{controlled}")
    item.setText(1, time_text(row.computed_until))
    item.setText(2, row.status)


def run_name(row: RunRow) -> str:
    """A run in one line, for lists."""
    started = "from the start" if row.branch_time is None else f"from {time_text(row.branch_time)}"
    return f"{row.label or row.case} {started} ({row.run[:6]})"
