from pytestqt.qtbot import QtBot

from viewer.gui.depth_plot import DepthPlot
from viewer.view_status import PointReadout, ViewStatus


def test_it_draws_the_record_in_minutes_and_marks_the_time_shown(qtbot: QtBot) -> None:
    plot = DepthPlot()
    qtbot.addWidget(plot)
    plot.show_status(
        ViewStatus(
            time=120.0,
            duration=600.0,
            probe=PointReadout(10.0, 20.0, 5.0, 1.5, 6.5),
            depth_record=((0.0, 60.0, 120.0), (0.0, 0.5, 1.5)),
        )
    )
    minutes, depths = plot.curve.getData()

    assert list(minutes) == [0.0, 1.0, 2.0]
    assert list(depths) == [0.0, 0.5, 1.5]
    assert plot.now.value() == 2.0
    assert plot.caption.text() == "x 10, y 20: depth 1.50 m, level 6.50 m, ground 5.00 m"
