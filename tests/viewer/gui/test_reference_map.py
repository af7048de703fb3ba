import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import OpenWindow, Recorder
from viewer.commands import FlyTo
from viewer.gui.reference_map import FRAME, LONGEST_SIDE, ReferenceMap
from viewer.world import MapView


def view(flood_col: int = 10) -> MapView:
    flood = np.zeros((50, 100), bool)
    flood[:, flood_col] = True
    relief = np.full((50, 100, 3), 150, np.uint8)
    corners = ((1400.0, 2100.0), (1500.0, 2100.0), (1550.0, 2200.0), (1350.0, 2200.0))
    return MapView(
        relief, flood, (1000.0, 2000.0, 2000.0, 2500.0), (1450.0, 2050.0), (1450.0, 2150.0), corners
    )


@pytest.fixture
def shown(qtbot: QtBot, record: Recorder) -> ReferenceMap:
    made = ReferenceMap(record)
    qtbot.addWidget(made)
    made.show_map(view())
    made.show()
    return made


def test_it_has_the_shape_of_the_terrain(shown: ReferenceMap) -> None:
    assert shown.width() == LONGEST_SIDE + 2 * FRAME
    assert shown.height() == LONGEST_SIDE // 2 + 2 * FRAME


def test_places_and_positions_are_inverse(shown: ReferenceMap) -> None:
    place = shown.place_at(shown.position_of(1234.0, 2345.0))

    assert place == pytest.approx((1234.0, 2345.0))
    assert shown.place_at(QPointF(-50.0, 1e4)) == pytest.approx((1000.0, 2000.0))


def test_a_click_travels_there(shown: ReferenceMap, record: Recorder, qtbot: QtBot) -> None:
    at = shown.position_of(1900.0, 2400.0).toPoint()
    qtbot.mouseClick(shown, Qt.MouseButton.LeftButton, pos=at)

    (command,) = record.commands
    assert isinstance(command, FlyTo)
    assert (command.x, command.y) == pytest.approx((1900.0, 2400.0), abs=5.0)
    assert command.distance is None


def test_water_eye_and_view_are_painted(shown: ReferenceMap) -> None:
    image = shown.grab().toImage()
    water = QColor(image.pixel(shown.position_of(1105.0, 2300.0).toPoint()))
    dry = QColor(image.pixel(shown.position_of(1800.0, 2300.0).toPoint()))
    seen = QColor(image.pixel(shown.position_of(1480.0, 2170.0).toPoint()))
    eye = QColor(image.pixel(shown.position_of(1450.0, 2050.0).toPoint()))

    assert water.blue() > water.red() + 60
    assert abs(dry.blue() - dry.red()) < 5
    assert seen.lightness() > dry.lightness() + 5
    assert eye.red() > eye.blue() + 60


def test_in_the_window_the_map_lies_in_the_upper_right_and_travels(opened: OpenWindow) -> None:
    small = opened.window.reference_map
    opened.until(small.isVisible)
    scene = opened.window.scene
    assert small.geometry().right() == pytest.approx(scene.width() - 13, abs=1)
    assert small.geometry().top() == 12
    work = opened.app.camera_work
    assert work is not None
    before = work.camera.target
    opened.bot.mouseClick(small, Qt.MouseButton.LeftButton, pos=QPoint(20, 20))
    opened.until(lambda: work.camera.target != before and not work.is_moving)
    x, y, _ = work.frame.from_world(work.camera.target)

    assert (x, y) == pytest.approx(small.place_at(QPointF(20.0, 20.0)), abs=10.0)


def test_the_menu_hides_and_shows_it(opened: OpenWindow) -> None:
    opened.until(opened.window.reference_map.isVisible)
    opened.window.view_menu.map_shown.trigger()
    opened.window.tick()
    assert not opened.window.reference_map.isVisible()
    opened.window.view_menu.map_shown.trigger()

    opened.until(opened.window.reference_map.isVisible)
