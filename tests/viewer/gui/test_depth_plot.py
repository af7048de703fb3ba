from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import ShowSeries
from viewer.gui.depth_plot import DepthPlot, RecordPlot
from viewer.units import US
from viewer.view_status import PlaceRow, PointReadout, ViewStatus

RECORD = ((0.0, 60.0, 120.0), (0.0, 0.5, 1.5))
SPEEDS = ((0.0, 120.0), (0.0, 2.0))


def test_it_draws_the_record_in_minutes_and_marks_the_time_shown(qtbot: QtBot, record: Recorder) -> None:
    plot = DepthPlot(record)
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


def test_speed_has_a_plot_of_its_own_once_it_is_known(qtbot: QtBot, record: Recorder) -> None:
    plot = DepthPlot(record)
    qtbot.addWidget(plot)
    readout = PointReadout(10.0, 20.0, 5.0, 1.5, 6.5, speed=2.0, bearing=271.6)
    plot.show_status(ViewStatus(time=60.0, probe=readout, depth_record=RECORD, speed_record=SPEEDS))

    assert not plot.of_speed.isHidden()
    assert list(plot.of_speed.curve.getData()[1]) == [0.0, 2.0]
    assert "2.00 m/s toward 272\u00b0" in plot.caption.text()


def test_the_run_compared_with_is_drawn_too_and_all_in_the_units_asked_for(
    qtbot: QtBot, record: Recorder
) -> None:
    plot = DepthPlot(record)
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
    plot.show_records(((0.0, 60.0), (0.0, 0.0)), ((), ()), ViewStatus(duration=60.0))
    low, high = plot.viewRange()[1]
    assert -0.01 <= low <= 0.0
    assert 0.1 <= high < 0.2
    plot.show_records(((0.0, 60.0), (0.0, 8.0)), ((0.0,), (9.0,)), ViewStatus(duration=60.0))

    assert 9.0 <= plot.viewRange()[1][1] < 11.0


TOWN, WALL = PlaceRow("town", "gauge"), PlaceRow("wall", "section")


def test_gauges_and_sections_are_chosen_from_the_list(qtbot: QtBot, record: Recorder) -> None:
    plot = DepthPlot(record)
    qtbot.addWidget(plot)
    plot.show_status(ViewStatus())
    assert plot.places.isHidden()
    plot.show_status(ViewStatus(places=(TOWN, WALL), series_of=WALL))

    assert [plot.places.itemText(k) for k in range(3)] == ["Clicked point", "Gauge town", "Section wall"]
    assert plot.places.currentIndex() == 2
    assert not plot.places.isHidden()
    assert record.commands == []
    for number in (1, 0):
        plot.places.activated.emit(number)
    assert record.commands == [ShowSeries("town", "gauge"), ShowSeries(None)]


def test_a_section_has_its_discharge_and_a_gauge_its_name(qtbot: QtBot, record: Recorder) -> None:
    plot = DepthPlot(record)
    qtbot.addWidget(plot)
    passed = ((0.0, 60.0), (0.0, -(0.3048**3)))
    plot.show_status(
        ViewStatus(time=60.0, places=(TOWN, WALL), series_of=WALL, discharge_record=passed, units=US)
    )
    assert list(plot.of_discharge.curve.getData()[1]) == [0.0, -1.0]
    assert plot.of_discharge.viewRange()[1][0] <= -1.0
    assert plot.caption.text() == "Section wall: -1.0 ft\u00b3/s to the right of its line"
    assert plot.of_depth.isHidden()
    assert not plot.of_discharge.isHidden()

    readout = PointReadout(10.0, 20.0, 5.0, 1.5, 6.5)
    plot.show_status(ViewStatus(places=(TOWN, WALL), series_of=TOWN, depth_record=RECORD, probe=readout))
    assert plot.caption.text() == "Gauge town: depth 1.50 m, level 6.50 m, ground 5.00 m"
    assert plot.of_discharge.isHidden()
    assert not plot.of_depth.isHidden()
