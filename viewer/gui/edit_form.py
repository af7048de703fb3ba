"""What an edit is: width, magnitude, operation and crest, of the next edit or of the selected one."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import (
    QButtonGroup,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QWidget,
)

from viewer.units import METRIC, Units
from viewer.view_status import EditSettings

__all__ = ["Choice", "EditForm"]

_LIMITS = {"width": (0.5, 5000.0), "magnitude": (0.1, 500.0), "level": (-5000.0, 9000.0)}
"""Least and most that the fields take [m]."""
_FIELD_WIDTH = 78
"""Least width of a field on the screen [pixels]."""
_CRESTS: dict[str, dict[str, object]] = {
    "modulate": {"type": "modulate", "at_level": False},
    "even": {"type": "replace", "at_level": False},
    "level": {"type": "replace", "at_level": True},
}


class EditForm(QWidget):
    """The numbers of an edit.

    Args:
        change: called with the name of a setting of `EditSettings` and its value [m], for each one changed.
        pick_level: called when the level is to be taken from the picture.
    """

    def __init__(self, change: Callable[..., None], pick_level: Callable[[], None]) -> None:
        super().__init__()
        self._units = METRIC
        self.width_m = self._number("Width", lambda value: change(width=value))
        self.magnitude_m = self._number("Magnitude", lambda value: change(magnitude=value))
        self.level_m = self._number("Level", lambda value: change(level=value))
        self.level_m.setToolTip("Elevation of the crest or floor above the vertical datum of the case")
        self.operation = Choice(
            "Operation",
            {"raise": ("Raise", "A levee: lift the ground"), "lower": ("Lower", "A trench: cut the ground")},
            lambda name: change(operation=name),
        )
        self.crest = Choice(
            "Crest",
            {
                "modulate": ("Follow ground", "Modulate: add the magnitude to the ground as it is"),
                "even": ("Even", "Replace: an even crest or floor above the ground at the drawn points"),
                "level": ("Level", "Replace: a crest or floor at an absolute elevation"),
            },
            lambda name: change(
                type="modulate" if name == "modulate" else "replace", at_level=name == "level"
            ),
        )
        self.pick = QPushButton("Pick")
        self.pick.setCheckable(True)
        self.pick.setAccessibleName("Take the level from the picture")
        self.pick.setToolTip("Click on water or ground: its level becomes that of the crest (Esc drops)")
        self.pick.clicked.connect(lambda: pick_level())
        form = QFormLayout(self)
        form.setContentsMargins(0, 0, 0, 0)
        form.setVerticalSpacing(4)
        form.addRow("Operation", self.operation)
        form.addRow("Crest", self.crest)
        form.addRow("Width", _side_by_side(self.width_m, QLabel("Magnitude"), self.magnitude_m))
        form.addRow("Level", _side_by_side(self.level_m, self.pick))

    def show_settings(
        self, settings: EditSettings, units: Units, *, is_area: bool = False, picks_level: bool = False
    ) -> None:
        """Show the numbers of an edit; those that mean nothing to it are greyed."""
        if units != self._units:
            self._units = units
            for name in _LIMITS:
                self._fit(self._box(name), name)
        for name in _LIMITS:
            box = self._box(name)
            if not box.hasFocus():
                blocked = box.blockSignals(True)
                box.setValue(units.shown(getattr(settings, name)))
                box.blockSignals(blocked)
        at_level = settings.type == "replace" and settings.at_level
        self.operation.show_choice(settings.operation)
        self.crest.show_choice("level" if at_level else "even" if settings.type == "replace" else "modulate")
        self.width_m.setEnabled(not is_area)
        self.magnitude_m.setEnabled(not at_level)
        self.level_m.setEnabled(at_level)
        self.pick.setChecked(picks_level)

    def _box(self, name: str) -> QDoubleSpinBox:
        boxes = {"width": self.width_m, "magnitude": self.magnitude_m, "level": self.level_m}
        return boxes[name]

    def _number(self, name: str, changed: Callable[[float], None]) -> QDoubleSpinBox:
        box = QDoubleSpinBox()
        box.setAccessibleName(name)
        box.setToolTip(f"{name} of the edit")
        box.setKeyboardTracking(False)
        box.setMinimumWidth(_FIELD_WIDTH)
        self._fit(box, name.lower())
        box.valueChanged.connect(lambda value: changed(self._units.metres(value)))
        return box

    def _fit(self, box: QDoubleSpinBox, name: str) -> None:
        """Let a field speak the units wanted."""
        low, high = _LIMITS[name]
        blocked = box.blockSignals(True)
        box.setDecimals(2 if name == "level" else 1)
        box.setRange(self._units.shown(low), self._units.shown(high))
        box.setSuffix(f" {self._units.length}")
        box.blockSignals(blocked)


def _side_by_side(*widgets: QWidget) -> QWidget:
    together = QWidget()
    row = QHBoxLayout(together)
    row.setContentsMargins(0, 0, 0, 0)
    for widget in widgets:
        row.addWidget(widget, int(isinstance(widget, QDoubleSpinBox)))
    return together


class Choice(QWidget):
    """Two or more exclusive buttons side by side."""

    def __init__(self, name: str, choices: dict[str, tuple[str, str]], chosen: Callable[[str], None]) -> None:
        super().__init__()
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
