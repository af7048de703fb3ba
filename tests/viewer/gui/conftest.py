"""A real window on a virtual display, connected to a tiny service on a real socket."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from tests.viewer.gl_thread import let_go_of_egl
from tests.viewer.tiny_service import TOKEN, TinyService
from viewer.app.viewer_app import ViewerApp
from viewer.app.window import make_window
from viewer.commands import Command, Pause, StartRun
from viewer.gui.main_window import MainWindow
from viewer.net import BackOff, ConnectionThread, FrameLoader
from viewer.view_status import ViewStatus


class Recorder:
    """Takes the commands that a panel makes."""

    def __init__(self) -> None:
        self.commands: list[Command] = []

    def __call__(self, command: Command) -> None:
        self.commands.append(command)


@dataclass
class OpenWindow:
    """A shown window with what stands behind it."""

    window: MainWindow
    app: ViewerApp
    service: TinyService
    bot: QtBot

    @property
    def status(self) -> ViewStatus:
        return self.app.fresh_status()

    def until(self, condition: Callable[[], bool], timeout_ms: int = 20_000) -> None:
        self.bot.waitUntil(condition, timeout=timeout_ms)

    def pixel_of(self, x: float, y: float) -> QPoint:
        """Where the ground point (x, y) is seen in the picture."""
        work, shown = self.app.camera_work, self.app.shown
        assert work is not None
        assert shown is not None
        scene = self.window.scene
        camera = work.camera
        world = work.frame.to_world(x, y, float(shown.heightfield.sample(x, y)))
        clip = (
            camera.projection(scene.width() / scene.height(), 1.0, 1e6) @ camera.view_matrix() @ [*world, 1.0]
        )
        ndc = clip[:2] / clip[3]
        return QPoint(
            round((ndc[0] + 1.0) / 2.0 * scene.width()), round((1.0 - ndc[1]) / 2.0 * scene.height())
        )

    def click(self, x: float, y: float) -> None:
        self.bot.mouseClick(self.window.scene, Qt.MouseButton.LeftButton, pos=self.pixel_of(x, y))


@pytest.fixture(autouse=True)
def _no_foreign_context_is_current() -> None:
    let_go_of_egl()


@pytest.fixture
def record() -> Recorder:
    return Recorder()


@pytest.fixture
def opened(qtbot: QtBot) -> Iterator[OpenWindow]:
    service = TinyService(computed=20)
    connection = ConnectionThread(service.url, TOKEN, back_off=BackOff(first_s=0.05, longest_s=0.1))
    app = ViewerApp(connection, FrameLoader(), StartRun("tiny"))
    connection.start()
    window = make_window(app, app.close)
    qtbot.addWidget(window)
    window.resize(1000, 640)
    window.show()
    qtbot.waitExposed(window)

    def is_active() -> bool:
        window.activateWindow()
        return window.isActiveWindow()

    qtbot.waitUntil(is_active)
    made = OpenWindow(window, app, service, qtbot)
    made.until(lambda: app.shown is not None and len(app.shown.timeline) >= 20)
    app.dispatch(Pause())
    made.until(lambda: window.scene.pictures > 0 and app.is_settled)
    yield made
    window.close()
    service.close()
