"""The View menu: how the picture is drawn, from where, and what lies beside it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtGui import QAction, QActionGroup, QKeySequence
from PySide6.QtWidgets import QDockWidget, QMenu, QWidget

from viewer.commands import FlyTo, ResetView, SetOption, TopView
from viewer.gui.conductor import Dispatch
from viewer.view_status import ViewStatus

__all__ = ["OptionValue", "ViewMenu"]

OptionValue = bool | float | str

EXAGGERATIONS = (1.0, 1.5, 2.0, 3.0, 5.0)
TAUS_PX = (0.5, 1.0, 2.0, 4.0, 8.0)
CONTOUR_INTERVALS_M = (0.0, 5.0, 10.0, 20.0, 50.0)
BLOCK_SIZES = (17.0, 33.0, 65.0)
BORDERS = {"ragged": "Ragged blocks", "trim": "Trim", "pad": "Pad"}
UNIT_NAMES = {"metric": "Metric", "us": "US customary"}
NUMBERED_VIEWS = 9


class ViewMenu(QMenu):
    """The menu of the window.

    Args:
        dispatch: carries out the commands.
        keep_view: called to keep the present view.
        parent: the window.

    Attributes:
        map_shown: action that shows and hides the reference map.
    """

    def __init__(self, dispatch: Dispatch, keep_view: Callable[[], None], parent: QWidget) -> None:
        super().__init__("&View", parent)
        self._dispatch = dispatch
        self._switches: dict[str, QAction] = {}
        self._choices: dict[str, dict[OptionValue, QAction]] = {}
        self._action("Whole terrain", "R", lambda: dispatch(ResetView()))
        self._action("From above", "T", lambda: dispatch(TopView()))
        self._action("Keep this view", "Ctrl+K", keep_view)
        self.kept_views = self.addMenu("Kept views")
        self.addSeparator()
        self._choice("Vertical exaggeration", "exaggeration", EXAGGERATIONS, 1.0, lambda v: f"{v:g} x")
        self._choice(
            "Contours", "contour_interval", CONTOUR_INTERVALS_M, 0.0, lambda v: f"{v:g} m" if v else "off"
        )
        self._choice("Units", "units", tuple(UNIT_NAMES), "metric", lambda v: UNIT_NAMES[str(v)])
        self.addSeparator()
        self._choice("Terrain error", "tau_px", TAUS_PX, 2.0, lambda v: f"{v:g} px")
        self._choice("Vertices along a block", "block_size", BLOCK_SIZES, 33.0, lambda v: f"{v:g}")
        self._choice("Border of the map", "border", tuple(BORDERS), "ragged", lambda v: BORDERS[str(v)])
        self._switch("Wireframe", "wireframe", "F")
        self._switch("Level-of-detail blocks", "show_blocks", None)
        self.addSeparator()
        self.map_shown = self._action("Reference map", "M", lambda: None)
        self.map_shown.setCheckable(True)
        self.map_shown.setChecked(True)
        self.show_views({}, lambda name: None)

    def add_docks(self, docks: list[QDockWidget]) -> None:
        """Let the docks be shown and hidden."""
        for dock in docks:
            self.addAction(dock.toggleViewAction())

    def add_first(self, actions: list[QAction]) -> None:
        """Offer actions of panels above the entries of this menu."""
        self.insertActions(self.actions()[0], actions)
        self.insertSeparator(self.actions()[len(actions)])

    def options(self) -> dict[str, OptionValue]:
        """Return what is marked, by option name."""
        chosen: dict[str, OptionValue] = {name: action.isChecked() for name, action in self._switches.items()}
        for name, choices in self._choices.items():
            for value, action in choices.items():
                if action.isChecked():
                    chosen[name] = value
        return chosen

    def show_status(self, status: ViewStatus) -> None:
        """Mark what is chosen; a value that the menu does not offer leaves its entries unmarked."""
        for name, value in status.options:
            if name in self._switches:
                _mark(self._switches[name], value is True)
            for offered, action in self._choices.get(name, {}).items():
                _mark(action, offered == value)

    def show_views(self, views: dict[str, FlyTo], forget: Callable[[str], None]) -> None:
        """Offer the kept views.

        Args:
            views: the flight to each, by name.
            forget: called with the name of a view that is not wanted any more.
        """
        self.kept_views.clear()
        for number, (name, flight) in enumerate(views.items(), start=1):
            action = self.kept_views.addAction(name)
            if number <= NUMBERED_VIEWS:
                action.setShortcut(QKeySequence(f"Ctrl+{number}"))
            action.triggered.connect(lambda _on, flight=flight: self._dispatch(flight))
        if views:
            self.kept_views.addSeparator()
            forgetting = self.kept_views.addMenu("Forget")
            for name in views:
                forgetting.addAction(name).triggered.connect(lambda _on, name=name: forget(name))
        self.kept_views.setEnabled(bool(views))

    def _action(self, text: str, shortcut: str | None, slot: Callable[[], object]) -> QAction:
        action = self.addAction(text)
        if shortcut is not None:
            action.setShortcut(QKeySequence(shortcut))
        action.triggered.connect(lambda: slot())
        return action

    def _switch(self, text: str, option: str, shortcut: str | None) -> None:
        action = self._action(text, shortcut, lambda: None)
        action.setCheckable(True)
        action.toggled.connect(lambda on: self._dispatch(SetOption(option, on)))
        self._switches[option] = action

    def _choice(
        self,
        text: str,
        option: str,
        values: tuple[OptionValue, ...],
        initial: OptionValue,
        label: Callable[[OptionValue], str],
    ) -> None:
        menu = self.addMenu(text)
        group = QActionGroup(menu)
        group.setExclusionPolicy(QActionGroup.ExclusionPolicy.ExclusiveOptional)
        self._choices[option] = {}
        for value in values:
            action = menu.addAction(label(value))
            action.setCheckable(True)
            action.setChecked(value == initial)
            action.triggered.connect(lambda _on, value=value: self._dispatch(SetOption(option, value)))
            group.addAction(action)
            self._choices[option][value] = action


def _mark(action: QAction, on: bool) -> None:
    blocked = action.blockSignals(True)
    action.setChecked(on)
    action.blockSignals(blocked)
