"""The real window on a virtual display with a real service: from start to the changed flood."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from tests.viewer.gl_thread import let_go_of_egl
from viewer.app.local_service import LocalService
from viewer.app.viewer_app import ViewerApp
from viewer.app.window import make_window
from viewer.commands import ChangeEditSettings, FollowLive, Seek
from viewer.gui.main_window import MainWindow
from viewer.net import ConnectionThread, FrameLoader


@pytest.fixture
def service(tmp_path: Path, case: str) -> Iterator[LocalService]:
    with LocalService(tmp_path / "store", ["--case", case, "--threads", "2"]) as made:
        yield made


def picture(window: MainWindow) -> np.ndarray:
    image = window.scene.grabFramebuffer().convertToFormat(QImage.Format.Format_RGB888)
    raw = np.frombuffer(image.constBits(), dtype=np.uint8)
    rows = raw.reshape(image.height(), image.bytesPerLine())[:, : 3 * image.width()]
    return rows.reshape(image.height(), image.width(), 3).copy()


def test_start_watch_draw_recalculate_and_see_the_change(
    service: LocalService, case: str, qtbot: QtBot
) -> None:
    let_go_of_egl()
    connection = ConnectionThread(service.url, service.token)
    app = ViewerApp(connection, FrameLoader())
    connection.start()
    window = make_window(app, app.close)
    qtbot.addWidget(window)
    window.resize(1000, 640)
    window.show()
    window.activateWindow()
    panel = window.run_panel.starting
    qtbot.waitUntil(lambda: panel.start.isEnabled() and panel.case.count() > 0, timeout=30_000)
    panel.choose_case(case)
    panel.duration_min.setValue(1.5)
    qtbot.mouseClick(panel.start, Qt.MouseButton.LeftButton)

    def frames() -> int:
        return 0 if app.shown is None else len(app.shown.timeline)

    qtbot.waitUntil(lambda: frames() >= 3, timeout=60_000)
    qtbot.waitUntil(lambda: window.scene.pictures > 2, timeout=60_000)
    assert app.fresh_status().follows_live
    qtbot.waitUntil(lambda: app.shown is not None and app.shown.timeline.last_time >= 90.0, timeout=90_000)
    app.dispatch(Seek(90.0))
    qtbot.waitUntil(lambda: app.is_settled and not app.clock.follows_live, timeout=30_000)
    app.dispatch(FollowLive(False))
    window.scene.repaint()
    before = picture(window)

    app.dispatch(Seek(15.0))
    app.dispatch(ChangeEditSettings(width=30.0, magnitude=25.0))
    window.edit_panel.line.trigger()
    qtbot.waitUntil(lambda: app.fresh_status().is_drawing)
    scene, grid = window.scene, app.shown.grid if app.shown is not None else None
    assert grid is not None
    for share in (0.2, 0.8):
        xmin, ymin, xmax, ymax = grid.extent
        x, y = xmin + share * (xmax - xmin), ymin + 0.42 * (ymax - ymin)
        qtbot.mouseClick(scene, Qt.MouseButton.LeftButton, pos=_pixel_of(app, window, x, y))
        qtbot.wait(50)
    qtbot.waitUntil(lambda: app.fresh_status().drawn_vertices == 2)
    qtbot.keyClick(scene, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: len(app.fresh_status().edits) == 1, timeout=20_000)
    parent = app.shown.run if app.shown is not None else ""
    qtbot.waitUntil(window.edit_panel.recalculate_button.isEnabled, timeout=20_000)
    qtbot.mouseClick(window.edit_panel.recalculate_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(
        lambda: app.shown is not None and app.shown.run != parent and not app.is_busy, timeout=60_000
    )
    assert app.fresh_status().recalculate_latency_s is not None
    qtbot.waitUntil(lambda: app.shown is not None and app.shown.timeline.last_time >= 90.0, timeout=90_000)
    app.dispatch(Seek(90.0))
    qtbot.waitUntil(lambda: app.is_settled, timeout=30_000)
    window.scene.repaint()
    after = picture(window)
    window.close()

    changed = np.abs(before.astype(int) - after.astype(int)).max(axis=2) > 24
    assert changed[:, : changed.shape[1] // 2].any()
    assert float(changed.mean()) > 0.01
    assert connection.state.phase == "closed"


def _pixel_of(app: ViewerApp, window: MainWindow, x: float, y: float) -> QPoint:
    work, shown = app.camera_work, app.shown
    assert work is not None
    assert shown is not None
    scene, camera = window.scene, work.camera
    world = work.frame.to_world(x, y, float(shown.heightfield.sample(x, y)))
    clip = camera.projection(scene.width() / scene.height(), 1.0, 1e6) @ camera.view_matrix() @ [*world, 1.0]
    ndc = clip[:2] / clip[3]
    return QPoint(round((ndc[0] + 1.0) / 2.0 * scene.width()), round((1.0 - ndc[1]) / 2.0 * scene.height()))
