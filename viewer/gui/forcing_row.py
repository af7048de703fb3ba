"""One item of the forcing: what the case says, and the fields that change it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from viewer.commands import ChangeForcing, ResetForcing
from viewer.gui.conductor import Dispatch
from viewer.view_status import ForcingRow

__all__ = ["ForcingRowEditor"]

Slot = Callable[[], None]

KINDS = {
    "source": "inflow",
    "discharge": "inflow at the edge",
    "stage": "level at the edge",
    "rain": "rain",
    "breach": "breach",
}
AS_CASE, AT_TIME, NEVER = range(3)


class ForcingRowEditor(QWidget):
    """Fields of one item.

    Args:
        row: the item.
        dispatch: takes the commands.
    """

    def __init__(self, row: ForcingRow, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.item = row.id
        self._kind = row.kind
        self._unit = row.unit
        self._dispatch = dispatch
        self._time = 0.0
        self.title = QLabel("")
        self.title.setWordWrap(True)
        self.case_text = QLabel("")
        self.case_text.setObjectName("faint")
        self.case_text.setWordWrap(True)
        self.reset = self._button("Reset", "Let it be as the case says", self._reset)
        head = QHBoxLayout()
        head.addWidget(self.title, 1)
        head.addWidget(self.reset)
        self._fields = QHBoxLayout()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addLayout(head)
        layout.addWidget(self.case_text)
        layout.addLayout(self._fields)
        if row.kind == "breach":
            self._add_start()
        else:
            self._add_values()

    def show_row(self, row: ForcingRow, time: float) -> None:
        """Show the item as it is now, at the playback time [s]."""
        self._time = time
        mark = "  \u25cf not recalculated" if row.is_pending else "  (changed)" if row.is_changed else ""
        self.title.setText(f"<b>{row.id}</b> {KINDS[row.kind] if row.id != row.kind else ''}{mark}")
        given = f"; changed to {row.series_text}" if row.series_text else ""
        self.case_text.setText(f"case: {row.case_text}{given}")
        self.reset.setEnabled(row.is_changed)
        if self._kind == "breach":
            choice = {"case": AS_CASE, "never": NEVER}.get(str(row.start), AT_TIME)
            self.choice.setCurrentIndex(choice)
            if not self.start_min.hasFocus():
                start = row.start if isinstance(row.start, float) else row.case_start
                _set(self.start_min, start / 60.0)
            self.start_min.setEnabled(choice == AT_TIME)
        elif self._kind == "stage":
            _set(self.offset, row.offset)
        else:
            self.factor.setEnabled(row.case_text != "none" or bool(row.series_text))
            _set(self.factor, row.factor)

    def _add_values(self) -> None:
        if self._kind == "stage":
            self.offset = _box(f"Raise {self.item} by", "What is added to the level", -1000.0, 1000.0, " m")
            self.offset.setPrefix("+ ")
            self.offset.valueChanged.connect(self._raised)
            self._fields.addWidget(self.offset)
        else:
            self.factor = _box(f"Factor of {self.item}", "What the values are multiplied by", 0.0, 1000.0, "")
            self.factor.setPrefix("x ")
            self.factor.setSingleStep(0.1)
            self.factor.valueChanged.connect(self._scaled)
            self._fields.addWidget(self.factor)
        self.load = self._button("Series ...", f"Load a series of {self._unit} from a CSV file", self._load)
        self.load.setAccessibleName(f"Load a series for {self.item}")
        self._fields.addWidget(self.load)

    def _add_start(self) -> None:
        self.choice = QComboBox()
        self.choice.addItems(["as the case says", "begins at", "never"])
        self.choice.setAccessibleName(f"When {self.item} begins")
        self.choice.setToolTip("When the breach begins; one that has begun cannot be moved")
        self.choice.activated.connect(self._chosen)
        self.start_min = _box(
            f"Beginning of {self.item}", "Simulation time of the beginning", 0.0, 1e6, " min"
        )
        self.start_min.valueChanged.connect(self._moved)
        self.now = self._button("Now", "Begin at the time shown", self._now)
        self.now.setAccessibleName(f"Let {self.item} begin now")
        for widget in (self.choice, self.start_min, self.now):
            self._fields.addWidget(widget)
        self.start_min.setMinimumWidth(80)

    def _scaled(self) -> None:
        self._dispatch(ChangeForcing(self.item, factor=self.factor.value()))

    def _raised(self) -> None:
        self._dispatch(ChangeForcing(self.item, offset=self.offset.value()))

    def _load(self) -> None:
        path, _ = QFileDialog.getOpenFileName(
            self, f"Series of {self.item} in {self._unit}", "", "Series (*.csv);;All files (*)"
        )
        if path:
            self._dispatch(ChangeForcing(self.item, series_file=path))

    def _chosen(self, choice: int) -> None:
        if choice == AT_TIME:
            self._moved()
        else:
            self._dispatch(ChangeForcing(self.item, start="never" if choice == NEVER else "case"))

    def _moved(self) -> None:
        self._dispatch(ChangeForcing(self.item, start=self.start_min.value() * 60.0))

    def _now(self) -> None:
        self._dispatch(ChangeForcing(self.item, start=self._time))

    def _reset(self) -> None:
        self._dispatch(ResetForcing(self.item))

    def _button(self, text: str, tip: str, slot: Slot) -> QPushButton:
        button = QPushButton(text)
        button.setToolTip(tip)
        button.setAccessibleName(f"{text.removesuffix(' ...')} {self.item}")
        button.clicked.connect(lambda: slot())
        return button


def _box(name: str, tip: str, low: float, high: float, suffix: str) -> QDoubleSpinBox:
    box = QDoubleSpinBox()
    box.setAccessibleName(name)
    box.setToolTip(tip)
    box.setRange(low, high)
    box.setDecimals(2)
    box.setSuffix(suffix)
    box.setKeyboardTracking(False)
    return box


def _set(box: QDoubleSpinBox, value: float) -> None:
    """Show a value, unless somebody is typing one."""
    if not box.hasFocus():
        with QSignalBlocker(box):
            box.setValue(value)
