"""The window: the picture in the middle, docks for runs, edits and the depth record, playback below."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QAction, QActionGroup, QCloseEvent, QKeySequence
from PySide6.QtWidgets import (
    QDockWidget,
    QFileDialog,
    QFrame,
    QMainWindow,
    QMenu,
    QMessageBox,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from viewer.commands import (
    BeginEdit,
    CancelEdit,
    Command,
    FollowLive,
    Pause,
    ResetView,
    SavePicture,
    Seek,
    SetOption,
    TogglePlay,
    TopView,
)
from viewer.gui.conductor import Conductor, Painter
from viewer.gui.depth_plot import DepthPlot
from viewer.gui.edit_panel import EditPanel
from viewer.gui.playback_bar import PlaybackBar
from viewer.gui.reference_map import ReferenceMap
from viewer.gui.run_panel import RunPanel
from viewer.gui.scene_widget import SceneWidget
from viewer.gui.status_line import StatusLine
from viewer.view_status import ViewStatus

__all__ = ["MainWindow"]

TICK_MS = 16
DOCK_WIDTH = 340
MAP_MARGIN = 12
EXAGGERATIONS = (1.0, 1.5, 2.0, 3.0, 5.0)
TAUS_PX = (0.5, 1.0, 2.0, 4.0, 8.0)
CONTOUR_INTERVALS_M = (0.0, 5.0, 10.0, 20.0, 50.0)


class MainWindow(QMainWindow):
    """The viewer's window.

    Args:
        conductor: carries out commands and knows the state.
        painter: draws the scene.
        closed: called once when the window is closing, while the OpenGL context still lives.
    """

    def __init__(
        self, conductor: Conductor, painter: Painter, closed: Callable[[], None] | None = None
    ) -> None:
        super().__init__()
        self._conductor = conductor
        self._closed = closed
        self._shown: ViewStatus | None = None
        self.failure: str | None = None
        self.setWindowTitle("Flood Emergency Visualizer")
        self.resize(1440, 900)
        self.scene = SceneWidget(conductor, painter)
        self.scene.failed.connect(self._fail)
        self.reference_map = ReferenceMap(self._dispatch, self.scene)
        self.scene.resized.connect(self._place_map)
        self.playback = PlaybackBar(self._dispatch)
        self.edit_panel = EditPanel(self._dispatch)
        self.run_panel = RunPanel(self._dispatch)
        self.depth_plot = DepthPlot()
        self.status_line = StatusLine()
        self.setStatusBar(self.status_line)
        middle = QWidget()
        layout = QVBoxLayout(middle)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.scene, 1)
        layout.addWidget(self.playback)
        self.setCentralWidget(middle)
        self.docks = [
            self._dock("Runs", self.run_panel, Qt.DockWidgetArea.RightDockWidgetArea),
            self._dock("Terrain edits", self.edit_panel, Qt.DockWidgetArea.RightDockWidgetArea),
            self._dock("Depth at a point", self.depth_plot, Qt.DockWidgetArea.RightDockWidgetArea),
        ]
        self.resizeDocks(self.docks, [DOCK_WIDTH] * len(self.docks), Qt.Orientation.Horizontal)
        self.resizeDocks(self.docks, [310, 330, 240], Qt.Orientation.Vertical)
        self._make_menus()
        self._timer = QTimer(self)
        self._timer.timeout.connect(self.tick)
        self._timer.start(TICK_MS)
        self.scene.setFocus()

    def tick(self) -> None:
        """Let the conductor move on; repaint the picture when it changed, the panels when their state did."""
        if self._conductor.advance(time.monotonic()):
            self.scene.update()
        status = self._conductor.status()
        self.status_line.show_status(status, self.scene.frames_per_second)
        self._show_map()
        if status is not self._shown:
            self._shown = status
            self.playback.show_status(status)
            self.edit_panel.show_status(status)
            self.run_panel.show_status(status)
            self.depth_plot.show_status(status)
            self.setWindowTitle(f"{status.title or 'no run'} - Flood Emergency Visualizer")
            self.scene.setCursor(
                Qt.CursorShape.CrossCursor if status.is_drawing else Qt.CursorShape.ArrowCursor
            )

    def closeEvent(self, event: QCloseEvent) -> None:
        """End cleanly: first the picture, then whatever the caller has to close."""
        self._timer.stop()
        self.scene.release()
        if self._closed is not None:
            closed, self._closed = self._closed, None
            closed()
        super().closeEvent(event)

    def _dispatch(self, command: Command) -> None:
        self._conductor.dispatch(command)

    def _show_map(self) -> None:
        if not self.map_shown.isChecked():
            return
        before = self.reference_map.size()
        view = self._conductor.map_view()
        self.reference_map.show_map(view)
        self.reference_map.setVisible(view is not None)
        if self.reference_map.size() != before:
            self._place_map()

    def _place_map(self) -> None:
        self.reference_map.move(self.scene.width() - self.reference_map.width() - MAP_MARGIN, MAP_MARGIN)

    def _fail(self, sentence: str) -> None:
        self.failure = sentence
        QMessageBox.critical(self, "No picture", sentence)
        self.close()

    def _dock(self, title: str, panel: QWidget, area: Qt.DockWidgetArea) -> QDockWidget:
        dock = QDockWidget(title, self)
        dock.setObjectName(title)
        scroll = QScrollArea()
        scroll.setWidget(panel)
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setMinimumWidth(panel.minimumSizeHint().width())
        dock.setWidget(scroll)
        self.addDockWidget(area, dock)
        return dock

    def _make_menus(self) -> None:
        file_menu = self.menuBar().addMenu("&File")
        self._action(file_menu, "Save picture ...", "Ctrl+S", self._save_picture)
        self._action(file_menu, "Quit", "Ctrl+Q", self.close)
        playback = self.menuBar().addMenu("&Playback")
        self._action(playback, "Play or pause", "Space", lambda: self._dispatch(TogglePlay()))
        self._action(playback, "Follow live", "L", lambda: self._dispatch(FollowLive(True)))
        self._action(playback, "Next frame", ".", lambda: self._step(1))
        self._action(playback, "Previous frame", ",", lambda: self._step(-1))
        self._action(playback, "To the start", "Home", lambda: self._dispatch(Seek(0.0)))
        edits = self.menuBar().addMenu("&Edits")
        self._action(edits, "Draw edit line", "B", self._toggle_drawing)
        edits.addAction(self.edit_panel.undo)
        edits.addAction(self.edit_panel.redo)
        edits.addSeparator()
        edits.addAction(self.edit_panel.recalculate)
        self._make_view_menu(self.menuBar().addMenu("&View"))

    def _make_view_menu(self, view: QMenu) -> None:
        self._action(view, "Whole terrain", "R", lambda: self._dispatch(ResetView()))
        self._action(view, "From above", "T", lambda: self._dispatch(TopView()))
        view.addSeparator()
        self._choices(view, "Vertical exaggeration", "exaggeration", EXAGGERATIONS, 1.0, lambda v: f"{v:g} x")
        self._choices(
            view,
            "Contours",
            "contour_interval",
            CONTOUR_INTERVALS_M,
            0.0,
            lambda v: f"{v:g} m" if v else "off",
        )
        self._choices(view, "Terrain error", "tau_px", TAUS_PX, 2.0, lambda v: f"{v:g} px")
        self._switch(view, "Depth classes", "depth_classes", "C")
        self._switch(view, "Wireframe", "wireframe", "F")
        self._switch(view, "Level-of-detail blocks", "show_blocks", None)
        view.addSeparator()
        self.map_shown = self._action(view, "Reference map", "M", lambda: None)
        self.map_shown.setCheckable(True)
        self.map_shown.setChecked(True)
        self.map_shown.toggled.connect(self.reference_map.setVisible)
        for dock in self.docks:
            view.addAction(dock.toggleViewAction())

    def _action(self, menu: QMenu, text: str, shortcut: str | None, slot: Callable[[], object]) -> QAction:
        action = menu.addAction(text)
        if shortcut is not None:
            action.setShortcut(QKeySequence(shortcut))
        action.triggered.connect(lambda: slot())
        return action

    def _switch(self, menu: QMenu, text: str, option: str, shortcut: str | None) -> None:
        action = menu.addAction(text)
        action.setCheckable(True)
        if shortcut is not None:
            action.setShortcut(QKeySequence(shortcut))
        action.toggled.connect(lambda on: self._dispatch(SetOption(option, on)))

    def _choices(
        self,
        menu: QMenu,
        text: str,
        option: str,
        values: tuple[float, ...],
        initial: float,
        label: Callable[[float], str],
    ) -> None:
        choices = menu.addMenu(text)
        group = QActionGroup(choices)
        for value in values:
            action = choices.addAction(label(value))
            action.setCheckable(True)
            action.setChecked(value == initial)
            action.triggered.connect(lambda _on, value=value: self._dispatch(SetOption(option, value)))
            group.addAction(action)

    def _toggle_drawing(self) -> None:
        self._dispatch(CancelEdit() if self._conductor.status().is_drawing else BeginEdit())

    def _step(self, frames: int) -> None:
        status = self._conductor.status()
        if status.output_interval > 0.0:
            index = round(status.time / status.output_interval) + frames
            self._dispatch(Pause())
            self._dispatch(Seek(max(0.0, index * status.output_interval)))

    def _save_picture(self) -> None:
        path, _ = QFileDialog.getSaveFileName(self, "Save picture", "flood.png", "PNG pictures (*.png)")
        if path:
            self._dispatch(SavePicture(path))
