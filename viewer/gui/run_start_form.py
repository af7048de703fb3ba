"""Start a run: case, duration, output interval, device, and the forcing of the table."""

from __future__ import annotations

from PySide6.QtWidgets import QCheckBox, QComboBox, QDoubleSpinBox, QFormLayout, QLabel, QPushButton, QWidget

from viewer.commands import StartRun
from viewer.gui.conductor import Dispatch
from viewer.view_status import CaseRow, ViewStatus

__all__ = ["RunStartForm"]


class RunStartForm(QWidget):
    """The upper part of the run dock."""

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self._cases: tuple[CaseRow, ...] = ()
        self._devices: tuple[str, ...] = ()
        self._shown_case: str | None = None
        self._is_forced = False
        self._is_connected = False
        self.case = QComboBox()
        self.case.setAccessibleName("Case")
        self.case.setToolTip("What to compute")
        self.case.currentIndexChanged.connect(self._show_case)
        self.about = QLabel("")
        self.about.setObjectName("faint")
        self.about.setWordWrap(True)
        self.duration_min = _box("Duration", "Simulated time of the run", 100_000.0, " min")
        self.interval_s = _box("Output interval", "Simulated time between two frames", 86_400.0, " s")
        self.device = QComboBox()
        self.device.setAccessibleName("Device")
        self.device.setToolTip("Where to compute; auto lets the service choose")
        self.device.addItem("auto")
        self.with_forcing = QCheckBox("With the changed forcing")
        self.with_forcing.setAccessibleName("Start with the changed forcing")
        self.start = QPushButton("Start run")
        self.start.setObjectName("primary")
        self.start.setAccessibleName("Start run")
        self.start.setToolTip("Compute this case from its start")
        self.start.clicked.connect(self._start)
        form = QFormLayout(self)
        form.setContentsMargins(0, 0, 0, 0)
        form.addRow("Case", self.case)
        form.addRow(self.about)
        form.addRow("Duration", self.duration_min)
        form.addRow("Output every", self.interval_s)
        form.addRow("Device", self.device)
        form.addRow(self.with_forcing)
        form.addRow(self.start)

    def show_status(self, status: ViewStatus) -> None:
        """Show the cases and the devices of the service."""
        self._is_connected = status.is_connected
        if status.cases != self._cases:
            self._cases = status.cases
            chosen = self.case.currentIndex()
            self.case.clear()
            self.case.addItems([row.title for row in status.cases])
            if 0 < chosen < len(status.cases):
                self.case.setCurrentIndex(chosen)
        if status.devices != self._devices:
            self._devices = status.devices
            self.device.clear()
            self.device.addItems(["auto", *(name for name in status.devices if name != "auto")])
        shown = next((row for row in status.runs if row.run == status.shown_run), None)
        self._shown_case = None if shown is None else shown.case
        self._is_forced = any(row.is_changed for row in status.forcing)
        self._allow()

    def choose_case(self, name: str) -> None:
        """Select the case called `name`, if the service offers it."""
        for row, case in enumerate(self._cases):
            if case.name == name:
                self.case.setCurrentIndex(row)

    @property
    def _chosen(self) -> CaseRow | None:
        row = self.case.currentIndex()
        return self._cases[row] if 0 <= row < len(self._cases) else None

    def _show_case(self) -> None:
        case = self._chosen
        if case is not None:
            self.duration_min.setValue(case.duration / 60.0)
            self.interval_s.setValue(case.output_interval)
            hypothetical = ", hypothetical" if case.hypothetical else ""
            self.about.setText(f"{case.name}: {case.cells:,} cells{hypothetical}")
        self._allow()

    def _allow(self) -> None:
        case = self._chosen
        self.start.setEnabled(self._is_connected and case is not None)
        is_of_shown = case is not None and case.name == self._shown_case
        self.with_forcing.setEnabled(is_of_shown and self._is_forced)
        why = "Begin with the changes of the forcing table"
        if not is_of_shown:
            why = "The forcing table is that of the shown run, which is of another case"
        elif not self._is_forced:
            why = "Nothing is changed in the forcing table"
        self.with_forcing.setToolTip(why)

    def _start(self) -> None:
        case = self._chosen
        if case is not None:
            self._dispatch(
                StartRun(
                    case.name,
                    self.duration_min.value() * 60.0,
                    self.interval_s.value(),
                    self.device.currentText(),
                    self.with_forcing.isEnabled() and self.with_forcing.isChecked(),
                )
            )


def _box(name: str, tip: str, longest: float, suffix: str) -> QDoubleSpinBox:
    box = QDoubleSpinBox()
    box.setAccessibleName(name)
    box.setToolTip(tip)
    box.setRange(0.1, longest)
    box.setDecimals(1)
    box.setSuffix(suffix)
    return box
