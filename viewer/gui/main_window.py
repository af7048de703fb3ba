"""The window: the picture in the middle, docks for runs, edits and the depth record, playback below."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QAction, QCloseEvent, QKeySequence
from PySide6.QtWidgets import (
    QDialog,
    QDockWidget,
    QFrame,
    QInputDialog,
    QMainWindow,
    QMenu,
    QMessageBox,
    QScrollArea,
    QToolBar,
    QWidget,
)

from viewer.commands import (
    BeginMeasure,
    Command,
    EndMeasure,
    FlyTo,
    FollowLive,
    Pause,
    SavePicture,
    Seek,
    SetOption,
    TogglePlay,
)
from viewer.gui.bindings_dialog import BindingsDialog
from viewer.gui.conductor import Conductor, Painter
from viewer.gui.connection_panel import ConnectionPanel
from viewer.gui.depth_plot import DepthPlot
from viewer.gui.edit_panel import EditPanel
from viewer.gui.forcing_panel import ForcingPanel
from viewer.gui.kept_settings import KeptSettings
from viewer.gui.layers_panel import LayersPanel
from viewer.gui.picture_dialog import PictureDialog, ask_picture_path
from viewer.gui.playback_bar import PlaybackBar
from viewer.gui.presenting_menu import PresentingMenu
from viewer.gui.reference_map import ReferenceMap
from viewer.gui.run_panel import RunPanel
from viewer.gui.scene_widget import SceneWidget
from viewer.gui.status_line import StatusLine
from viewer.gui.swipe_handle import SwipeHandle
from viewer.gui.view_menu import ViewMenu
from viewer.gui.water_panel import WaterPanel
from viewer.tools import Bindings
from viewer.view_status import ViewStatus

__all__ = ["MainWindow"]

TICK_MS = 16
LEFT_WIDTH = 290
RIGHT_WIDTH = 340
MAP_MARGIN = 12
_CURSORS = {
    "measure": Qt.CursorShape.CrossCursor,
    "line": Qt.CursorShape.CrossCursor,
    "area": Qt.CursorShape.CrossCursor,
    "level": Qt.CursorShape.WhatsThisCursor,
    "select": Qt.CursorShape.PointingHandCursor,
}


class MainWindow(QMainWindow):
    """The viewer's window.

    Args:
        conductor: carries out commands and knows the state.
        painter: draws the scene.
        closed: called once when the window is closing, while the OpenGL context still lives.
        kept: what to remember between starts; None remembers nothing.
    """

    def __init__(
        self,
        conductor: Conductor,
        painter: Painter,
        closed: Callable[[], None] | None = None,
        kept: KeptSettings | None = None,
    ) -> None:
        super().__init__()
        self._conductor = conductor
        self._closed = closed
        self._kept = kept
        self._views: dict[str, FlyTo] = {}
        self._shown: ViewStatus | None = None
        self.failure: str | None = None
        self.setWindowTitle("Flood Emergency Visualizer")
        self.resize(1440, 900)
        self.scene = SceneWidget(conductor, painter)
        self.scene.failed.connect(self._fail)
        self.reference_map = ReferenceMap(self._dispatch, self.scene)
        self.scene.resized.connect(self._place_map)
        self.swipe_handle = SwipeHandle(self._dispatch, self.scene)
        self.scene.resized.connect(self.swipe_handle.place)
        self.playback = PlaybackBar(self._dispatch)
        self.playback.stepped.connect(self._step)
        self.edit_panel = EditPanel(self._dispatch)
        self.run_panel = RunPanel(self._dispatch)
        self.forcing_panel = ForcingPanel(self._dispatch)
        self.depth_plot = DepthPlot(self._dispatch)
        self.water_panel = WaterPanel(self._dispatch)
        self.connection_panel = ConnectionPanel(self._dispatch)
        self.layers_panel = LayersPanel(self._dispatch)
        self.status_line = StatusLine()
        self.setStatusBar(self.status_line)
        self.setCentralWidget(self.scene)
        below = QToolBar("Playback", self)
        below.setObjectName("Playback")
        below.setMovable(False)
        below.toggleViewAction().setEnabled(False)  # a flood without its time is not to be had by mistake
        below.addWidget(self.playback)
        self.addToolBar(Qt.ToolBarArea.BottomToolBarArea, below)  # as wide as the window, docks and all
        left, right = Qt.DockWidgetArea.LeftDockWidgetArea, Qt.DockWidgetArea.RightDockWidgetArea
        runs = self._dock("Runs", self.run_panel, right)
        edits = self._dock("Terrain edits", self.edit_panel, right)
        forcing = self._dock("Forcing", self.forcing_panel, right)
        water = self._dock("Water", self.water_panel, left)
        layers = self._dock("Layers", self.layers_panel, left)
        record = self._dock("Depth at a point", self.depth_plot, left)
        connection = self._dock("Connection", self.connection_panel, left)
        self.docks = [runs, edits, forcing, water, layers, record, connection]
        for beside, dock in ((edits, forcing), (layers, connection)):
            self.tabifyDockWidget(beside, dock)
            beside.raise_()
        self.resizeDocks([runs, water], [RIGHT_WIDTH, LEFT_WIDTH], Qt.Orientation.Horizontal)
        self.resizeDocks([runs, edits], [330, 500], Qt.Orientation.Vertical)
        self.resizeDocks([water, layers, record], [230, 330, 270], Qt.Orientation.Vertical)
        self.view_menu = ViewMenu(self._dispatch, self._keep_view, self)
        self.view_menu.map_shown.toggled.connect(self.reference_map.setVisible)
        self._make_menus()
        self._shortcuts = {_name_of(action): action for action in self._menu_actions()}
        self._default_shortcuts = {name: a.shortcut().toString() for name, a in self._shortcuts.items()}
        self._bindings = Bindings()
        self._restore()
        self._timer = QTimer(self)
        self._timer.timeout.connect(self.tick)
        self._timer.start(TICK_MS)
        self.scene.setFocus()

    def tick(self) -> None:
        """Let the conductor move on; repaint the picture when it changed, the panels when their state did."""
        if self._conductor.advance(time.monotonic()):
            self.scene.update()
        status = self._conductor.status()
        self.status_line.show_status(status, self.scene.frames_per_second, self.scene.render_scale)
        self._show_map()
        if status is not self._shown:
            if self._shown is None or status.title != self._shown.title:
                self._views = self._kept.views(status.title) if self._kept is not None else {}
                self.view_menu.show_views(self._views, self._forget_view)
            self._shown = status
            self.playback.show_status(status)
            self.edit_panel.show_status(status)
            self.run_panel.show_status(status)
            self.forcing_panel.show_status(status)
            self.depth_plot.show_status(status)
            self.water_panel.show_status(status)
            self.swipe_handle.show_status(status)
            self.connection_panel.show_status(status)
            self.layers_panel.show_status(status)
            self.view_menu.show_status(status)
            self.presenting_menu.show_status(status)
            self.measure.setChecked(status.is_measuring)
            self.setWindowTitle(f"{status.title or 'no run'} - Flood Emergency Visualizer")
            tool = "measure" if status.is_measuring else status.edit_tool
            self.scene.setCursor(_CURSORS.get(tool, Qt.CursorShape.ArrowCursor))

    def closeEvent(self, event: QCloseEvent) -> None:
        """End cleanly: first the picture, then whatever the caller has to close."""
        self._timer.stop()
        self._keep()
        self.scene.release()
        if self._closed is not None:
            closed, self._closed = self._closed, None
            closed()
        super().closeEvent(event)

    def _dispatch(self, command: Command) -> None:
        self._conductor.dispatch(command)

    def _restore(self) -> None:
        if self._kept is None:
            return
        self._kept.restore_window(self)
        now = dict(self._conductor.status().options)
        for name, value in self._kept.options().items():
            if name in now and type(value) is type(now[name]):  # another version may have had others
                self._dispatch(SetOption(name, value))
        self.view_menu.map_shown.setChecked(self._kept.map_shown())
        self._dispatch(self._kept.edit_settings())
        self._bind(self._kept.bindings())

    def _keep(self) -> None:
        if self._kept is None:
            return
        self._kept.keep_window(self)
        self._kept.keep_options(dict(self._conductor.status().options))
        self._kept.keep_map_shown(self.view_menu.map_shown.isChecked())
        self._kept.keep_edit_settings(self._conductor.status().edit_settings)

    def _keep_view(self) -> None:
        flight = self._conductor.view_pose()
        if flight is None:
            return
        number = next(k for k in itertools.count(1) if f"View {k}" not in self._views)
        name, is_given = QInputDialog.getText(self, "Keep this view", "Name", text=f"View {number}")
        if is_given and name.strip():
            self._change_views({**self._views, name.strip(): flight})

    def _forget_view(self, name: str) -> None:
        self._change_views({kept: view for kept, view in self._views.items() if kept != name})

    def _change_views(self, views: dict[str, FlyTo]) -> None:
        self._views = views
        self.view_menu.show_views(views, self._forget_view)
        if self._kept is not None and self._shown is not None:
            self._kept.keep_views(self._shown.title, views)

    def _show_map(self) -> None:
        if not self.view_menu.map_shown.isChecked():
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
        bar = scroll.verticalScrollBar().sizeHint().width()
        scroll.setMinimumWidth(panel.minimumSizeHint().width() + bar)
        dock.setWidget(scroll)
        self.addDockWidget(area, dock)
        return dock

    def _make_menus(self) -> None:
        file_menu = self.menuBar().addMenu("&File")
        self._action(file_menu, "Connect to ...", "Ctrl+O", self.connection_panel.ask)
        self._action(file_menu, "Save picture ...", "Ctrl+S", self._save_picture)
        self._action(file_menu, "Export picture ...", "Ctrl+Shift+S", self._export_picture)
        self._action(file_menu, "Quit", "Ctrl+Q", self.close)
        playback = self.menuBar().addMenu("&Playback")
        self._action(playback, "Play or pause", "Space", lambda: self._dispatch(TogglePlay()))
        self._action(playback, "Follow live", "L", lambda: self._dispatch(FollowLive(True)))
        self._action(playback, "Next frame", ".", lambda: self._step(1))
        self._action(playback, "Previous frame", ",", lambda: self._step(-1))
        self._action(playback, "To the start", "Home", lambda: self._dispatch(Seek(0.0)))
        edits = self.menuBar().addMenu("&Edits")
        for action in self.edit_panel.menu_actions():
            edits.addAction(action) if action is not None else edits.addSeparator()
        self.view_menu.add_first([self.water_panel.next_colour, self.water_panel.toggle_arrows])
        self.menuBar().addMenu(self.view_menu)
        self.presenting_menu = PresentingMenu(self._dispatch, self)
        self.menuBar().addMenu(self.presenting_menu)
        self.view_menu.add_docks(self.docks)
        tools = self.menuBar().addMenu("&Tools")
        self.measure = self._action(tools, "Measure distance and area", "G", self._toggle_measuring)
        self.measure.setCheckable(True)
        self._action(tools, "Keys and mouse ...", None, self._change_bindings)

    def _action(self, menu: QMenu, text: str, shortcut: str | None, slot: Callable[[], object]) -> QAction:
        action = menu.addAction(text)
        if shortcut is not None:
            action.setShortcut(QKeySequence(shortcut))
        action.triggered.connect(lambda: slot())
        return action

    def _menu_actions(self) -> list[QAction]:
        menus = [menu for bar in self.menuBar().actions() if isinstance(menu := bar.menu(), QMenu)]
        return [action for menu in menus for action in menu.actions() if _name_of(action)]

    def _bind(self, bindings: Bindings) -> None:
        self._bindings = bindings
        self.scene.bind(bindings)
        for name, action in self._shortcuts.items():
            text = bindings.shortcuts.get(name, self._default_shortcuts[name])
            action.setShortcut(QKeySequence(text))

    def _change_bindings(self) -> None:
        dialog = BindingsDialog(self._bindings, self._default_shortcuts, self)
        if dialog.exec() == QDialog.DialogCode.Accepted:
            self._bind(dialog.bindings)
            if self._kept is not None:
                self._kept.keep_bindings(self._bindings)

    def _toggle_measuring(self) -> None:
        self._dispatch(EndMeasure() if self._conductor.status().is_measuring else BeginMeasure())

    def _step(self, frames: int) -> None:
        status = self._conductor.status()
        if status.output_interval > 0.0:
            index = round(status.time / status.output_interval) + frames
            self._dispatch(Pause())
            self._dispatch(Seek(max(0.0, index * status.output_interval)))

    def _save_picture(self) -> None:
        path = ask_picture_path(self)
        if path:
            self._dispatch(SavePicture(path))

    def _export_picture(self) -> None:
        dialog = PictureDialog(self)
        if dialog.exec() == QDialog.DialogCode.Accepted:
            self._dispatch(dialog.command)


def _name_of(action: QAction) -> str:
    """The name of an entry in the table of shortcuts; empty for separators, submenus and docks."""
    if action.menu() is not None or isinstance(action.parent(), QDockWidget):
        return ""
    return action.text().replace("&", "").removesuffix(" ...")
