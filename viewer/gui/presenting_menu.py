"""The menu to show one's view to the others, or to follow somebody's."""

from __future__ import annotations

from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QMenu, QWidget

from viewer.commands import FollowView, PresentView
from viewer.gui.conductor import Dispatch
from viewer.view_status import PresenterRow, ViewStatus

__all__ = ["PresentingMenu"]


class PresentingMenu(QMenu):
    """The presentation menu of the window.

    Attributes:
        present: shows this view to the others.
        free: flies freely again.
    """

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__("P&resentation", parent)
        self._dispatch = dispatch
        self._presenters: tuple[PresenterRow, ...] | None = None
        self._group = QActionGroup(self)
        self.present = self.addAction("Present my view")
        self.present.setCheckable(True)
        self.present.setShortcut("Ctrl+P")
        self.present.triggered.connect(lambda on: dispatch(PresentView(on)))
        self.addSeparator()
        self.free = self.addAction("Fly freely")
        self.free.setCheckable(True)
        self.free.triggered.connect(lambda _on: dispatch(FollowView(None)))
        self._group.addAction(self.free)
        self.show_status(ViewStatus())

    def show_status(self, status: ViewStatus) -> None:
        """Offer the sessions that present, and mark the one that is followed."""
        self.present.setEnabled(status.has_terrain and status.is_connected)
        self.present.setChecked(status.is_presenting)
        if status.presenters != self._presenters:
            self._presenters = status.presenters
            for action in self._group.actions()[1:]:
                self._group.removeAction(action)
                self.removeAction(action)
            for row in status.presenters:
                action = self.addAction(f"Follow {row.client or 'session'} {row.session[:8]}")
                action.setCheckable(True)
                action.setData(row.session)
                action.triggered.connect(lambda _on, session=row.session: self._dispatch(FollowView(session)))
                self._group.addAction(action)
        for action in self._group.actions():
            action.setChecked(action.data() == status.followed)
