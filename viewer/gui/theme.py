"""Colours and sizes of the window: a quiet dark frame round the picture."""

from __future__ import annotations

from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QApplication

__all__ = ["ACCENT", "BRANCH", "COMPUTED", "TRACK", "apply_theme"]

ACCENT = "#3d9be0"
COMPUTED = "#2f6f9f"
BRANCH = "#f0a840"
TRACK = "#2b3138"

_WINDOW = "#1e2328"
_BASE = "#161a1e"
_RAISED = "#2b3138"
_TEXT = "#e6eaee"
_FAINT = "#94a0ab"

_STYLE = f"""
QMainWindow, QDockWidget {{ color: {_TEXT}; }}
QDockWidget::title {{ background: {_RAISED}; padding: 6px 8px; }}
QGroupBox {{ border: 1px solid {_RAISED}; border-radius: 4px; margin-top: 14px; padding: 6px; }}
QGroupBox::title {{ subcontrol-origin: margin; left: 8px; color: {_FAINT}; }}
QPushButton, QToolButton {{ background: {_RAISED}; border: 1px solid #3a424b; border-radius: 4px; padding:
5px 10px; }} QPushButton:hover, QToolButton:hover {{ border-color: {ACCENT}; }}
QPushButton:pressed, QToolButton:pressed {{ background: #20262c; }}
QPushButton:checked, QToolButton:checked {{ background: #24557d; border-color: {ACCENT}; }}
QPushButton:disabled, QToolButton:disabled {{ color: #66707a; }}
QPushButton#primary {{ background: #1f6fb2; border-color: {ACCENT}; font-weight: bold; padding: 8px 10px; }}
QPushButton#primary:disabled {{ background: {_RAISED}; border-color: #3a424b; }}
QLabel#clock {{ font-size: 17px; font-weight: bold; }}
QLabel#faint {{ color: {_FAINT}; }}
QStatusBar {{ background: {_BASE}; }}
QStatusBar::item {{ border: none; }}
QStatusBar QLabel {{ padding: 0 8px; color: {_TEXT}; }}
QHeaderView::section {{ background: {_RAISED}; border: none; padding: 4px; }}
QTreeWidget, QListWidget {{ background: {_BASE}; border: 1px solid {_RAISED}; border-radius: 4px; }}
"""


def apply_theme(application: QApplication) -> None:
    """Give the application the Fusion style, a dark palette and the sizes used everywhere."""
    application.setStyle("Fusion")
    palette = QPalette()
    roles = {
        QPalette.ColorRole.Window: _WINDOW,
        QPalette.ColorRole.WindowText: _TEXT,
        QPalette.ColorRole.Base: _BASE,
        QPalette.ColorRole.AlternateBase: _WINDOW,
        QPalette.ColorRole.Text: _TEXT,
        QPalette.ColorRole.Button: _RAISED,
        QPalette.ColorRole.ButtonText: _TEXT,
        QPalette.ColorRole.ToolTipBase: _RAISED,
        QPalette.ColorRole.ToolTipText: _TEXT,
        QPalette.ColorRole.PlaceholderText: _FAINT,
        QPalette.ColorRole.Highlight: ACCENT,
        QPalette.ColorRole.HighlightedText: "#ffffff",
    }
    for role, colour in roles.items():
        palette.setColor(role, QColor(colour))
    for role in (QPalette.ColorRole.Text, QPalette.ColorRole.ButtonText, QPalette.ColorRole.WindowText):
        palette.setColor(QPalette.ColorGroup.Disabled, role, QColor("#66707a"))
    application.setPalette(palette)
    application.setStyleSheet(_STYLE)
