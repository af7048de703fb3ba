from pytestqt.qtbot import QtBot

from viewer.gui.status_line import StatusLine, age_text, readout_text
from viewer.units import US
from viewer.view_status import PointReadout, ViewStatus


def test_a_point_is_told_wet_or_dry() -> None:
    assert readout_text(None) == ""
    assert readout_text(PointReadout(0.0, 0.0, 12.0, 0.0, None)) == "dry, ground 12.00 m"
    wet = PointReadout(0.0, 0.0, 12.0, 1.5, 13.5)
    assert readout_text(wet) == "depth 1.50 m, level 13.50 m, ground 12.00 m"
    assert readout_text(wet, US) == "depth 4.92 ft, level 44.29 ft, ground 39.37 ft"


def test_the_age_of_the_data_is_told_once_it_matters() -> None:
    assert age_text(ViewStatus()) == ""
    assert age_text(ViewStatus(is_connected=True, data_age=0.0)) == "data up to date"
    assert age_text(ViewStatus(is_connected=False, data_age=0.0)) == "data 00:00:00 old"
    assert age_text(ViewStatus(is_connected=True, data_age=75.0)) == "data 00:01:15 old"


def test_the_line_says_how_far_the_numbers_can_be_trusted(qtbot: QtBot) -> None:
    line = StatusLine()
    qtbot.addWidget(line)
    status = ViewStatus(
        connection="reconnecting in 3 s (attempt 2)",
        message="picture written",
        speed_x_real_time=43.2,
        volume_error_relative=2.9e-8,
        has_terrain=True,
        time=3600.0,
        clock="2024-07-01 13:00:00 +0200",
        revision=4,
    )
    line.show_status(status, 24.6)

    assert line.connection.text() == "reconnecting in 3 s (attempt 2)"
    assert line.message.text() == "picture written"
    assert line.time.text() == "01:00:00 2024-07-01 13:00:00 +0200"
    assert line.revision.text() == "edits rev 4"
    assert line.computation.text() == "43 x real time"
    assert line.volume.text() == "volume error 2.9e-08"
    assert line.rate.text() == "25 fps"
    line.show_status(status, 11.2, 0.65)
    assert line.rate.text() == "11 fps at 65 %"


def test_what_is_not_known_is_left_out(qtbot: QtBot) -> None:
    line = StatusLine()
    qtbot.addWidget(line)
    line.show_status(ViewStatus(), 0.0)

    assert (line.computation.text(), line.volume.text(), line.rate.text()) == ("", "", "")
    assert (line.revision.text(), line.age.text()) == ("", "")


def test_a_long_message_does_not_widen_the_window_and_is_told_whole_in_the_tip(qtbot: QtBot) -> None:
    line = StatusLine()
    qtbot.addWidget(line)
    width = line.minimumSizeHint().width()
    line.show_status(ViewStatus(message="edits written to " + "a/" * 300), 0.0)

    assert line.minimumSizeHint().width() - width < 400  # the other labels
    assert line.message.toolTip() == line.message.text()
