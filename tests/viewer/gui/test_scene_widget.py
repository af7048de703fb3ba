import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QSurfaceFormat, QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import OpenWindow
from viewer.errors import ContextError
from viewer.gui.scene_widget import SceneWidget, surface_format


def test_opengl_4_1_core_is_asked_for() -> None:
    wanted = surface_format()

    assert (wanted.majorVersion(), wanted.minorVersion()) == (4, 1)
    assert wanted.profile() == QSurfaceFormat.OpenGLContextProfile.CoreProfile


def test_a_left_drag_turns_the_camera(opened: OpenWindow) -> None:
    work = opened.app.camera_work
    assert work is not None
    before = work.camera
    scene = opened.window.scene
    opened.bot.mousePress(scene, Qt.MouseButton.LeftButton, pos=QPoint(200, 200))
    for step in range(1, 6):
        opened.bot.mouseMove(scene, QPoint(200 + 20 * step, 200))
        opened.bot.wait(20)
    opened.bot.mouseRelease(scene, Qt.MouseButton.LeftButton, pos=QPoint(300, 200))

    opened.until(lambda: abs(work.camera.azimuth - before.azimuth) > 0.1)
    assert work.camera.distance == pytest.approx(before.distance)


def test_the_wheel_comes_nearer_to_the_ground_under_the_pointer(opened: OpenWindow) -> None:
    work = opened.app.camera_work
    assert work is not None
    before = work.camera.distance
    scene = opened.window.scene
    at = QPointF(opened.pixel_of(1500.0, 2500.0))
    turn = QWheelEvent(
        at,
        scene.mapToGlobal(at),
        QPoint(0, 0),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(scene, turn)

    opened.until(lambda: work.camera.distance < 0.95 * before and not work.is_moving)
    moved = QPointF(opened.pixel_of(1500.0, 2500.0)) - at
    assert abs(moved.x()) <= 2.0
    assert abs(moved.y()) <= 8.0  # the target glides onto the ground
    middle = QPointF(opened.pixel_of(*work.frame.from_world(work.camera.target)[:2]))
    assert abs(middle.x() - scene.width() / 2) <= 2.0


def test_a_held_key_moves_the_target_until_it_is_let_go(opened: OpenWindow) -> None:
    work = opened.app.camera_work
    assert work is not None
    before = work.camera.target
    scene = opened.window.scene
    opened.bot.keyPress(scene, Qt.Key.Key_D)
    opened.until(lambda: work.camera.target[0] > before[0] + 5.0)
    opened.bot.keyRelease(scene, Qt.Key.Key_D)

    opened.until(lambda: not work.is_moving)


def test_a_click_on_the_ground_probes_the_place_that_is_seen_there(opened: OpenWindow) -> None:
    opened.click(1300.0, 2400.0)
    opened.until(lambda: opened.status.probe is not None)
    probe = opened.status.probe

    assert probe is not None
    assert (probe.x, probe.y) == pytest.approx((1300.0, 2400.0), abs=12.0)


def test_a_bare_hover_reads_out_the_ground(opened: OpenWindow) -> None:
    opened.bot.mouseMove(opened.window.scene, opened.pixel_of(1300.0, 2400.0))
    opened.until(lambda: opened.status.hover is not None)
    hover = opened.status.hover

    assert hover is not None
    assert (hover.x, hover.y) == pytest.approx((1300.0, 2400.0), abs=12.0)


def test_without_a_good_context_it_says_why(qtbot: QtBot, opened: OpenWindow) -> None:
    class Refusing:
        def open(self) -> None:
            raise ContextError("OpenGL 4.1 is needed, this one offers 3.3")

    widget = SceneWidget(opened.app, Refusing())  # type: ignore[arg-type]
    qtbot.addWidget(widget)
    with qtbot.waitSignal(widget.failed) as caught:
        widget.show()

    assert caught.args == ["OpenGL 4.1 is needed, this one offers 3.3"]
