from pytestqt.qtbot import QtBot

from viewer.gui.depth_plot import DepthPlot, RecordPlot
from viewer.units import US
from viewer.view_status import PointReadout, ViewStatus

RECORD = ((0.0, 60.0, 120.0), (0.0, 0.5, 1.5))
SPEEDS = ((0.0, 120.0), (0.0, 2.0))


def test_it_draws_the_record_in_minutes_and_marks_the_time_shown(qtbot: QtBot) -> None:
    plot = DepthPlot()
    qtbot.addWidget(plot)
    plot.show_status(
        ViewStatus(
            time=120.0,
            duration=600.0,
            probe=PointReadout(10.0, 20.0, 5.0, 1.5, 6.5),
            depth_record=RECORD,
        )
    )
    minutes, depths = plot.of_depth.curve.getData()

    assert list(minutes) == [0.0, 1.0, 2.0]
    assert list(depths) == [0.0, 0.5, 1.5]
    assert plot.of_depth.now.value() == 2.0
    assert plot.caption.text() == "x 10, y 20: depth 1.50 m, level 6.50 m, ground 5.00 m"
    assert plot.of_speed.isHidden()


def test_speed_has_a_plot_of_its_own_once_it_is_known(qtbot: QtBot) -> None:
    plot = DepthPlot()
    qtbot.addWidget(plot)
    readout = PointReadout(10.0, 20.0, 5.0, 1.5, 6.5, speed=2.0, bearing=271.6)
    plot.show_status(ViewStatus(time=60.0, probe=readout, depth_record=RECORD, speed_record=SPEEDS))

    assert not plot.of_speed.isHidden()
    assert list(plot.of_speed.curve.getData()[1]) == [0.0, 2.0]
    assert "2.00 m/s toward 272\u00b0" in plot.caption.text()


def test_the_run_compared_with_is_drawn_too_and_all_in_the_units_asked_for(qtbot: QtBot) -> None:
    plot = DepthPlot()
    qtbot.addWidget(plot)
    other = ((0.0, 60.0), (0.0, 0.3048))
    plot.show_status(
        ViewStatus(depth_record=RECORD, other_depth_record=other, other_speed_record=other, units=US)
    )

    assert list(plot.of_depth.other.getData()[1]) == [0.0, 1.0]
    assert list(plot.of_speed.other.getData()[1]) == [0.0, 1.0]
    assert not plot.of_speed.isHidden()


def test_dry_ground_is_a_line_at_the_foot_of_the_plot(qtbot: QtBot) -> None:
    plot = RecordPlot("depth")
    qtbot.addWidget(plot)
    plot.show_records(((0.0, 60.0), (0.0, 0.0)), ((), ()), 0.0, 60.0)
    low, high = plot.viewRange()[1]
    assert -0.01 <= low <= 0.0
    assert 0.1 <= high < 0.2
    plot.show_records(((0.0, 60.0), (0.0, 8.0)), ((0.0,), (9.0,)), 0.0, 60.0)

    assert 9.0 <= plot.viewRange()[1][1] < 11.0
