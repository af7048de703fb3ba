from pytestqt.qtbot import QtBot

from viewer.gui.status_line import StatusLine, readout_text
from viewer.view_status import PointReadout, ViewStatus


def test_a_point_is_told_wet_or_dry() -> None:
    assert readout_text(None) == ""
    assert readout_text(PointReadout(0.0, 0.0, 12.0, 0.0, None)) == "dry, ground 12.00 m"
    wet = PointReadout(0.0, 0.0, 12.0, 1.5, 13.5)
    assert readout_text(wet) == "depth 1.50 m, level 13.50 m, ground 12.00 m"


def test_the_line_says_how_far_the_numbers_can_be_trusted(qtbot: QtBot) -> None:
    line = StatusLine()
    qtbot.addWidget(line)
    status = ViewStatus(
        connection="reconnecting in 3 s (attempt 2)",
        message="picture written",
        speed_x_real_time=43.2,
        volume_error_relative=2.9e-8,
    )
    line.show_status(status, 24.6)

    assert line.connection.text() == "reconnecting in 3 s (attempt 2)"
    assert line.message.text() == "picture written"
    assert line.computation.text() == "43 x real time"
    assert line.volume.text() == "volume error 2.9e-08"
    assert line.rate.text() == "25 fps"


def test_what_is_not_known_is_left_out(qtbot: QtBot) -> None:
    line = StatusLine()
    qtbot.addWidget(line)
    line.show_status(ViewStatus(), 0.0)

    assert (line.computation.text(), line.volume.text(), line.rate.text()) == ("", "", "")
