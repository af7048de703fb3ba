"""The working list of edits: what each is, how long, how much ground, what was overtopped."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QColor, QIcon, QPixmap
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QMenu, QSizePolicy, QWidget

from viewer.gui.theme import BRANCH
from viewer.view_status import EditRow

__all__ = ["EditListView"]

_ID = Qt.ItemDataRole.UserRole
_RAISE, _LOWER = QColor(255, 184, 77), QColor(140, 191, 255)
_SWATCH_PX = 10


class EditListView(QListWidget):
    """Edits that count from the next Recalculate on, and below them those that were undone.

    Args:
        select: called with the id of the edit that the user selects; None for none.
        fly_to: called with the middle of the edit that is double-clicked.
    """

    def __init__(
        self,
        select: Callable[[str | None], None],
        fly_to: Callable[[tuple[float, float]], None],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._rows: tuple[EditRow, ...] = ()
        self._undone: tuple[EditRow, ...] = ()
        self._select = select
        self._fly_to = fly_to
        self.setAccessibleName("Edits")
        self.setToolTip("Edits of the shown run; a new one counts from the next Recalculate on")
        self.setMinimumHeight(96)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
        self.setWordWrap(True)
        self.menu = QMenu(self)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(self._open_menu)
        self.itemSelectionChanged.connect(self._selection_changed)
        self.itemDoubleClicked.connect(self._double_clicked)

    def add_to_menu(self, actions: Sequence[QAction]) -> None:
        """Put actions into the menu of the right button."""
        self.menu.addActions(list(actions))

    def show_rows(self, rows: tuple[EditRow, ...], undone: tuple[EditRow, ...], selected: str | None) -> None:
        """Show the working list and what was undone."""
        blocked = self.blockSignals(True)
        if (rows, undone) != (self._rows, self._undone):
            self._rows, self._undone = rows, undone
            self.clear()
            for row in rows:
                self._add(row)
            for row in undone:
                self._add_undone(row)
        for number, row in enumerate(rows):
            item = self.item(number)
            if item.isSelected() != (row.id == selected):
                item.setSelected(row.id == selected)
                if row.id == selected:
                    self.setCurrentItem(item)
                    self.scrollToItem(item)
        self.blockSignals(blocked)

    def _add(self, row: EditRow) -> None:
        item = QListWidgetItem(_swatch(row), _text(row), self)
        item.setData(_ID, row.id)
        if row.warning:
            item.setForeground(QColor(BRANCH))

    def _add_undone(self, row: EditRow) -> None:
        item = QListWidgetItem(_swatch(row), f"undone: {_title(row)}", self)
        item.setFlags(Qt.ItemFlag.NoItemFlags)
        font = item.font()
        font.setItalic(True)
        item.setFont(font)

    def _selection_changed(self) -> None:
        chosen = self.selectedItems()
        self._select(str(chosen[0].data(_ID)) if chosen else None)

    def _double_clicked(self, item: QListWidgetItem) -> None:
        for row in self._rows:
            if row.id == item.data(_ID):
                self._fly_to(row.centre)

    def _open_menu(self, at: QPoint) -> None:
        item = self.itemAt(at)
        if item is not None and item.data(_ID) is not None:
            self.setCurrentItem(item)
            self.menu.popup(self.viewport().mapToGlobal(at))


def _swatch(row: EditRow) -> QIcon:
    picture = QPixmap(_SWATCH_PX, _SWATCH_PX)
    picture.fill(_RAISE if row.settings.operation == "raise" else _LOWER)
    return QIcon(picture)


def _title(row: EditRow) -> str:
    return f"{row.name}: {row.text}" if row.name else row.text


def _text(row: EditRow) -> str:
    first = f"{'' if row.is_applied else 'new: '}{_title(row)}"
    return "\n".join(line for line in (first, row.measure, row.warning) if line)
