"""Start a run; see the tree of runs and branches; pause, go on, stop."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QSizePolicy,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from viewer.commands import CompareWith, PauseRun, ResumeRun, SelectRun, StartRun, StopRun
from viewer.gui.conductor import Dispatch
from viewer.view_status import CaseRow, RunRow, ViewStatus, time_text

__all__ = ["RunPanel"]

RUN_ROLE = Qt.ItemDataRole.UserRole


class RunPanel(QWidget):
    """The run dock."""

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self._cases: tuple[CaseRow, ...] = ()
        self._runs: tuple[RunRow, ...] = ()
        self._devices: tuple[str, ...] = ()
        self.case = QComboBox()
        self.case.setAccessibleName("Case")
        self.case.currentIndexChanged.connect(self._show_case)
        self.about = QLabel("")
        self.about.setObjectName("faint")
        self.about.setWordWrap(True)
        self.duration_min = _minutes("Duration", 100_000.0)
        self.interval_s = _seconds("Output interval", 86_400.0)
        self.device = QComboBox()
        self.device.setAccessibleName("Device")
        self.device.addItem("auto")
        self.start = QPushButton("Start run")
        self.start.setObjectName("primary")
        self.start.setToolTip("Compute this case from its start")
        self.start.clicked.connect(self._start)
        self.tree = QTreeWidget()
        self.tree.setAccessibleName("Runs and branches")
        self.tree.setHeaderLabels(["Run", "Computed", "State"])
        self.tree.setRootIsDecorated(True)
        self.tree.setIndentation(14)
        self.tree.setMinimumHeight(72)
        self.tree.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
        self.tree.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.tree.header().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.tree.header().setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.tree.header().setSectionResizeMode(2, QHeaderView.ResizeMode.ResizeToContents)
        self.tree.header().setStretchLastSection(False)
        self.tree.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.tree.itemClicked.connect(lambda item: dispatch(SelectRun(item.data(0, RUN_ROLE))))
        self.pause = self._button("Pause", "Hold the computation of the shown run", PauseRun())
        self.resume = self._button("Resume", "Let the computation of the shown run go on", ResumeRun())
        self.stop = self._button("Stop", "End the computation of the shown run; its frames stay", StopRun())
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
        self._lay_out()

    def show_status(self, status: ViewStatus) -> None:
        """Show the cases, the devices and the tree of runs."""
        self.start.setEnabled(status.is_connected and bool(status.cases))
        if status.cases != self._cases:
            self._cases = status.cases
            self.case.clear()
            self.case.addItems([row.title for row in status.cases])
        if status.devices != self._devices:
            self._devices = status.devices
            self.device.clear()
            self.device.addItems(["auto", *(name for name in status.devices if name != "auto")])
        if status.runs != self._runs:
            self._runs = status.runs
            self._show_runs(status.runs)
        self._mark_shown(status.shown_run)
        self._show_comparison(status)
        shown = next((row for row in status.runs if row.run == status.shown_run), None)
        self.pause.setEnabled(shown is not None and shown.status in ("running", "starting"))
        self.resume.setEnabled(shown is not None and shown.status == "paused")
        self.stop.setEnabled(shown is not None and shown.status in ("running", "starting", "paused"))

    def _show_comparison(self, status: ViewStatus) -> None:
        shown = next((row for row in status.runs if row.run == status.shown_run), None)
        others = [] if shown is None else [row for row in status.runs if row.case == shown.case]
        choices: list[tuple[str, str | None]] = [("nothing", None)]
        choices += [(_run_name(row), row.run) for row in others if row is not shown]
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

    def choose_case(self, name: str) -> None:
        """Select the case called `name`, if the service offers it."""
        for row, case in enumerate(self._cases):
            if case.name == name:
                self.case.setCurrentIndex(row)

    def _show_case(self, row: int) -> None:
        if not 0 <= row < len(self._cases):
            return
        case = self._cases[row]
        self.duration_min.setValue(case.duration / 60.0)
        self.interval_s.setValue(case.output_interval)
        hypothetical = ", hypothetical" if case.hypothetical else ""
        self.about.setText(f"{case.name}: {case.cells:,} cells{hypothetical}")

    def _start(self) -> None:
        row = self.case.currentIndex()
        if 0 <= row < len(self._cases):
            self._dispatch(
                StartRun(
                    self._cases[row].name,
                    self.duration_min.value() * 60.0,
                    self.interval_s.value(),
                    self.device.currentText(),
                )
            )

    def _show_runs(self, runs: tuple[RunRow, ...]) -> None:
        known = {item.data(0, RUN_ROLE): item for item in self._items()}
        if set(known) - {row.run for row in runs}:
            self.tree.clear()
            known = {}
        pending = list(runs)
        while pending:
            placeable = [row for row in pending if row.parent is None or row.parent in known] or pending
            for row in placeable:
                item = known.get(row.run)
                if item is None:
                    parent = known.get(row.parent or "")
                    item = QTreeWidgetItem(self.tree) if parent is None else QTreeWidgetItem(parent)
                    item.setData(0, RUN_ROLE, row.run)
                    known[row.run] = item
                    item.setExpanded(True)
                    if parent is not None:
                        parent.setExpanded(True)
                label = row.case if row.branch_time is None else f"from {time_text(row.branch_time)}"
                item.setText(0, label)
                item.setToolTip(0, f"{row.title} ({row.run}) on {row.device}")
                item.setText(1, time_text(row.computed_until))
                item.setText(2, row.status)
            pending = [row for row in pending if row.run not in known]

    def _mark_shown(self, run: str | None) -> None:
        for item in self._items():
            font = item.font(0)
            font.setBold(item.data(0, RUN_ROLE) == run)
            item.setFont(0, font)
            item.setSelected(item.data(0, RUN_ROLE) == run)

    def _items(self) -> list[QTreeWidgetItem]:
        items: list[QTreeWidgetItem] = []
        pending = [self.tree.topLevelItem(row) for row in range(self.tree.topLevelItemCount())]
        while pending:
            item = pending.pop()
            if item is not None:
                items.append(item)
                pending.extend(item.child(row) for row in range(item.childCount()))
        return items

    def _button(self, text: str, tip: str, command: PauseRun | ResumeRun | StopRun) -> QPushButton:
        button = QPushButton(text)
        button.setToolTip(tip)
        button.clicked.connect(lambda: self._dispatch(command))
        return button

    def _lay_out(self) -> None:
        form = QFormLayout()
        form.addRow("Case", self.case)
        form.addRow(self.about)
        form.addRow("Duration", self.duration_min)
        form.addRow("Output every", self.interval_s)
        form.addRow("Device", self.device)
        control = QHBoxLayout()
        for button in (self.pause, self.resume, self.stop):
            control.addWidget(button)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        layout.addWidget(self.start)
        layout.addWidget(self.tree, 1)
        layout.addLayout(control)
        comparing = QFormLayout()
        comparing.addRow("Compare with", self.compare)
        comparing.addRow("", self.compare_mode)
        layout.addLayout(comparing)


def _run_name(row: RunRow) -> str:
    started = "from the start" if row.branch_time is None else f"from {time_text(row.branch_time)}"
    return f"{row.case} {started} ({row.run[:6]})"


def _minutes(name: str, longest: float) -> QDoubleSpinBox:
    return _box(name, longest, " min")


def _seconds(name: str, longest: float) -> QDoubleSpinBox:
    return _box(name, longest, " s")


def _box(name: str, longest: float, suffix: str) -> QDoubleSpinBox:
    box = QDoubleSpinBox()
    box.setAccessibleName(name)
    box.setRange(0.1, longest)
    box.setDecimals(1)
    box.setSuffix(suffix)
    return box
