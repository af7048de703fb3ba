import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from viewer.gui.time_slider import TimeSlider


@pytest.fixture
def slider(qtbot: QtBot) -> TimeSlider:
    made = TimeSlider()
    qtbot.addWidget(made)
    made.resize(600, 28)
    made.show()
    made.show_times(100.0, 500.0, 1000.0, 50.0)
    return made


def test_positions_and_times_are_each_others_inverse(slider: TimeSlider) -> None:
    for time in (0.0, 123.0, 500.0):
        assert slider.time_at(slider.position_of(time)) == pytest.approx(time)


def test_nobody_gets_beyond_what_is_computed(slider: TimeSlider, qtbot: QtBot) -> None:
    chosen: list[float] = []
    slider.time_chosen.connect(chosen.append)
    qtbot.mouseClick(slider, Qt.MouseButton.LeftButton, pos=QPoint(580, 14))

    assert chosen == [500.0]


def test_the_keyboard_moves_it_too(slider: TimeSlider, qtbot: QtBot) -> None:
    chosen: list[float] = []
    slider.time_chosen.connect(chosen.append)
    qtbot.keyClick(slider, Qt.Key.Key_Right)

    assert chosen == [pytest.approx(105.0)]


def test_showing_a_time_is_not_choosing_it(slider: TimeSlider) -> None:
    chosen: list[float] = []
    slider.time_chosen.connect(chosen.append)
    slider.show_times(300.0, 500.0, 1000.0, None)

    assert chosen == []


def test_computed_range_and_branch_mark_are_drawn(slider: TimeSlider) -> None:
    with_branch = slider.grab().toImage()
    slider.show_times(100.0, 900.0, 1000.0, None)
    without = slider.grab().toImage()

    assert with_branch.pixelColor(round(slider.position_of(700.0)), 14) != without.pixelColor(
        round(slider.position_of(700.0)), 14
    )
    assert with_branch.pixelColor(round(slider.position_of(50.0)), 7) != without.pixelColor(
        round(slider.position_of(50.0)), 7
    )
