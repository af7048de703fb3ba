"""What is on the picture, layer by layer, and how the ground is lit and drawn."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCheckBox, QFormLayout, QHBoxLayout, QLabel, QSlider, QVBoxLayout, QWidget

from viewer.commands import SetOption
from viewer.gui.conductor import Dispatch
from viewer.view_status import ViewStatus

__all__ = ["LayersPanel"]

LAYERS = {
    "show_water": ("Water", "The flood"),
    "show_terrain": ("Ground", "The terrain"),
    "show_imagery": ("Imagery on the ground", "The picture of the land that comes with the case, if any"),
    "show_edits": ("Marks of edits", "Lines and colours where the ground is raised or lowered"),
    "show_gauges": ("Gauges and sections", "Marks where the case records depth, speed and discharge"),
    "show_text": ("Title, legend and scale", "What is written on the picture"),
    "show_sky": ("Sky", "The sky, which the water mirrors"),
    "fog": ("Haze", "Far ground fades into the horizon"),
}


class LayersPanel(QWidget):
    """The layers dock.

    Attributes:
        layers: the check boxes by option name.
        sliders: the sliders by option name.
    """

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self.layers: dict[str, QCheckBox] = {}
        self.sliders: dict[str, _OptionSlider] = {}
        layout = QVBoxLayout(self)
        for name, (text, tip) in LAYERS.items():
            box = QCheckBox(text)
            box.setToolTip(tip)
            box.clicked.connect(lambda on, name=name: dispatch(SetOption(name, on)))
            layout.addWidget(box)
            self.layers[name] = box
        form = QFormLayout()
        self._slider(form, "Heights", "exaggeration", (0.5, 10.0, 0.25), "{:g} x", "Vertical exaggeration")
        self._slider(form, "Sun from", "light_azimuth_deg", (0.0, 360.0, 5.0), "{:g} deg", "Compass bearing")
        self._slider(
            form, "Sun height", "light_elevation_deg", (5.0, 90.0, 1.0), "{:g} deg", "Above the horizon"
        )
        self._slider(
            form, "Detail", "tau_px", (0.25, 10.0, 0.25), "{:g} px", "Largest error of the ground drawn"
        )
        layout.addLayout(form)
        layout.addStretch(1)

    def show_status(self, status: ViewStatus) -> None:
        """Show what is chosen."""
        options = dict(status.options)
        for name, box in self.layers.items():
            if name in options:
                box.setChecked(bool(options[name]))
        for name, slider in self.sliders.items():
            value = options.get(name)
            if isinstance(value, float):
                slider.show_value(value)

    def _slider(
        self,
        form: QFormLayout,
        label: str,
        name: str,
        span: tuple[float, float, float],
        text: str,
        tip: str,
    ) -> None:
        slider = _OptionSlider(span, text, tip)
        slider.slider.valueChanged.connect(lambda _: self._dispatch(SetOption(name, slider.value)))
        form.addRow(label, slider)
        self.sliders[name] = slider


class _OptionSlider(QWidget):
    """A slider over (least, greatest, step) with its value beside it."""

    def __init__(self, span: tuple[float, float, float], text: str, tip: str) -> None:
        super().__init__()
        self._least, greatest, self._step = span
        self._text = text
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.slider.setRange(0, round((greatest - self._least) / self._step))
        self.slider.setPageStep(4)
        self.slider.setAccessibleName(tip)
        self.slider.setToolTip(tip)
        self.number = QLabel("")
        self.number.setMinimumWidth(56)
        self.slider.valueChanged.connect(lambda _: self._tell(self.value))
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.slider, 1)
        layout.addWidget(self.number)

    @property
    def value(self) -> float:
        """The value that is set."""
        return self._least + self._step * self.slider.value()

    def show_value(self, value: float) -> None:
        """Show a value, as near as the steps allow, without asking for it."""
        blocked = self.slider.blockSignals(True)
        self.slider.setValue(round((value - self._least) / self._step))
        self.slider.blockSignals(blocked)
        self._tell(value)

    def _tell(self, value: float) -> None:
        self.number.setText(self._text.format(value))
