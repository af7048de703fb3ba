from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import FollowLive, Loop, Seek, SetSpeed, TogglePlay
from viewer.gui.playback_bar import PlaybackBar
from viewer.view_status import ViewStatus

STATUS = ViewStatus(
    shown_run="r",
    has_terrain=True,
    time=600.0,
    computed_until=1800.0,
    duration=3600.0,
    playback_speed=60.0,
    is_playing=True,
)


def bar(qtbot: QtBot, record: Recorder) -> PlaybackBar:
    made = PlaybackBar(record)
    qtbot.addWidget(made)
    made.resize(900, 40)
    made.show()
    made.show_status(STATUS)
    return made


def test_it_shows_time_computed_range_speed_and_state(qtbot: QtBot, record: Recorder) -> None:
    made = bar(qtbot, record)

    assert made.clock.text() == "00:10:00"
    assert made.extent.text() == "00:30:00 of 01:00:00 computed"
    assert made.play.text() == "Pause"
    assert made.speed.currentText() == "60 x"
    assert not made.follow.isChecked()


def test_its_buttons_make_commands(qtbot: QtBot, record: Recorder) -> None:
    made = bar(qtbot, record)
    qtbot.mouseClick(made.play, Qt.MouseButton.LeftButton)
    made.follow.click()
    made.speed.activated.emit(made.speed.findData(300.0))

    assert record.commands == [TogglePlay(), FollowLive(True), SetSpeed(300.0)]


def test_a_press_on_the_time_bar_seeks(qtbot: QtBot, record: Recorder) -> None:
    made = bar(qtbot, record)
    x = round(made.slider.position_of(900.0))
    qtbot.mouseClick(made.slider, Qt.MouseButton.LeftButton, pos=QPoint(x, made.slider.height() // 2))

    (command,) = record.commands
    assert isinstance(command, Seek)
    assert abs(command.time - 900.0) < 20.0


def test_showing_a_state_makes_no_command(qtbot: QtBot, record: Recorder) -> None:
    bar(qtbot, record).show_status(STATUS)

    assert record.commands == []


def test_an_unusual_speed_is_shown_too(qtbot: QtBot, record: Recorder) -> None:
    made = bar(qtbot, record)
    made.show_status(ViewStatus(shown_run="r", playback_speed=6.5))

    assert made.speed.currentText() == "6.5 x"


def test_frames_are_stepped_and_playing_loops(qtbot: QtBot, record: Recorder) -> None:
    made = bar(qtbot, record)
    steps: list[int] = []
    made.stepped.connect(steps.append)
    for button in (made.back, made.forth):
        qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(made.loop, Qt.MouseButton.LeftButton, pos=QPoint(6, made.loop.height() // 2))

    assert steps == [-1, 1]
    assert record.commands == [Loop(True)]
    made.show_status(ViewStatus(shown_run="r", loops=True))
    assert made.loop.isChecked()
