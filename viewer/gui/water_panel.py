"""How the water is shown: what it is coloured by, what the colours mean, and arrows of the flow."""

from __future__ import annotations

from PySide6.QtGui import QAction, QColor, QKeySequence, QPixmap
from PySide6.QtWidgets import QCheckBox, QComboBox, QFormLayout, QGridLayout, QLabel, QVBoxLayout, QWidget

from viewer.commands import SetOption
from viewer.gui.conductor import Dispatch
from viewer.view_status import LegendRow, ViewStatus

__all__ = ["WaterPanel"]

COLOURS = (
    ("natural", "Natural water"),
    ("depth", "Depth"),
    ("speed", "Speed"),
    ("hazard", "Hazard"),
    ("max_depth", "Greatest depth"),
    ("max_speed", "Greatest speed"),
    ("max_hazard", "Greatest hazard"),
    ("arrival", "Arrival time"),
)
SWATCH = (26, 14)


class WaterPanel(QWidget):
    """The water dock.

    Args:
        dispatch: carries out the commands.

    Attributes:
        next_colour: action that goes on to the next way to colour that the run offers.
        toggle_arrows: action that shows and hides the arrows.
    """

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self.colour = QComboBox()
        self.colour.setAccessibleName("Colour water by")
        self.colour.setToolTip("What the colours of the water mean; the legend is on the picture, too")
        for value, text in COLOURS:
            self.colour.addItem(text, value)
        self.colour.activated.connect(
            lambda row: dispatch(SetOption("water_colour", self.colour.itemData(row)))
        )
        self.arrows = QCheckBox("Arrows of the flow")
        self.arrows.setAccessibleName("Arrows of the flow")
        self.arrows.setToolTip("Arrows that point with the flow, the longer the faster")
        self.arrows.clicked.connect(lambda on: dispatch(SetOption("flow_arrows", on)))
        self.note = QLabel("")
        self.note.setObjectName("faint")
        self.note.setWordWrap(True)
        self.note.setAccessibleName("About the colours of the water")
        self.legend = QGridLayout()
        self.legend.setColumnStretch(1, 1)
        self._legend: tuple[LegendRow, ...] = ()
        self._offered: tuple[str, ...] | None = None
        self.next_colour = QAction("Next water colours", self)
        self.next_colour.setShortcut(QKeySequence("C"))
        self.next_colour.triggered.connect(lambda: self._go_on())
        self.toggle_arrows = QAction("Arrows of the flow", self)
        self.toggle_arrows.setShortcut(QKeySequence("V"))
        self.toggle_arrows.triggered.connect(lambda: self.arrows.click())
        form = QFormLayout()
        form.addRow("Colour by", self.colour)
        form.addRow(self.arrows)
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        layout.addWidget(self.note)
        layout.addLayout(self.legend)
        layout.addStretch(1)

    def show_status(self, status: ViewStatus) -> None:
        """Show what is chosen, what the run offers, and the legend."""
        if status.water_colours != self._offered:
            self._offered = status.water_colours
            model = self.colour.model()
            for row, (value, _) in enumerate(COLOURS):
                item = model.item(row)  # type: ignore[attr-defined]
                item.setEnabled(value in status.water_colours)
                item.setToolTip("" if value in status.water_colours else "The run does not keep this")
            self.arrows.setEnabled("speed" in status.water_colours)
        self.colour.setCurrentIndex(max(0, self.colour.findData(status.water_colour)))
        self.arrows.setChecked(status.flow_arrows)
        self.note.setText(status.water_note)
        self.note.setVisible(bool(status.water_note))
        if status.legend != self._legend:
            self._legend = status.legend
            self._show_legend(status.legend)

    def _go_on(self) -> None:
        offered = [value for value, _ in COLOURS if value in (self._offered or ())]
        if offered:
            now = self.colour.currentData()
            at = offered.index(now) if now in offered else -1
            self._dispatch(SetOption("water_colour", offered[(at + 1) % len(offered)]))

    def _show_legend(self, rows: tuple[LegendRow, ...]) -> None:
        while (item := self.legend.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.deleteLater()
        for place, row in enumerate(reversed(rows)):
            pixels = QPixmap(*SWATCH)
            pixels.fill(QColor(*row.colour))
            swatch = QLabel()
            swatch.setPixmap(pixels)
            self.legend.addWidget(swatch, place, 0)
            self.legend.addWidget(QLabel(row.text), place, 1)
