from PySide6.QtGui import QPalette
from PySide6.QtWidgets import QApplication

from viewer.gui.theme import apply_theme


def luminance(palette: QPalette, role: QPalette.ColorRole) -> float:
    def linear(channel: float) -> float:
        return channel / 12.92 if channel <= 0.04045 else ((channel + 0.055) / 1.055) ** 2.4

    colour = palette.color(role)
    return 0.2126 * linear(colour.redF()) + 0.7152 * linear(colour.greenF()) + 0.0722 * linear(colour.blueF())


def test_text_stands_out_from_its_ground_by_more_than_seven_to_one(qapp: QApplication) -> None:
    before, sheet, style = qapp.palette(), qapp.styleSheet(), qapp.style().objectName()
    apply_theme(qapp)
    palette = qapp.palette()
    qapp.setPalette(before)
    qapp.setStyleSheet(sheet)
    qapp.setStyle(style)
    pairs = [
        (QPalette.ColorRole.WindowText, QPalette.ColorRole.Window),
        (QPalette.ColorRole.Text, QPalette.ColorRole.Base),
        (QPalette.ColorRole.ButtonText, QPalette.ColorRole.Button),
    ]
    for text, ground in pairs:
        ratio = (luminance(palette, text) + 0.05) / (luminance(palette, ground) + 0.05)
        assert ratio > 7.0, (text, ratio)
