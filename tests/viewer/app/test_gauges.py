import numpy as np
import pytest

import protocol
from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import GRID
from viewer.app.gauges import MOST_MARKS
from viewer.commands import CommandError, ProbeAt, SetOption, ShowSeries, TopView
from viewer.render import FrameInputs, LineStyle
from viewer.view_status import PlaceRow

DRY, DEEP = (1500.0, 2650.0), (1045.0, 2365.0)
"""On a hillside, and in the river."""
BEND = ((1200.0, 2100.0), (1200.0, 2200.0), (1500.0, 2200.0))


def watch(flight: Flight, gauges: int = 2) -> None:
    """Let the service have told of gauges and a section that share a name."""
    places = [protocol.GaugePlace("hill", *DRY), protocol.GaugePlace("river", *DEEP)]
    places += [protocol.GaugePlace(f"more {k}", *DRY) for k in range(gauges - 2)]
    told = protocol.Places(flight.shown.run, tuple(places), (protocol.SectionPlace("river", BEND),))
    flight.app.desk.book.places[told.run] = told
    flight.do(TopView())
    flight.settle()


def inputs(flight: Flight) -> FrameInputs:
    made = flight.app.frame_inputs()
    assert made is not None
    return made


def test_marks_stand_on_ground_and_water_and_at_the_middle_of_the_section(flight: Flight) -> None:
    assert inputs(flight).marks == ()
    watch(flight)
    field, marks = flight.shown.heightfield, inputs(flight).marks
    ground = [float(field.sample(*at)) for at in (DRY, DEEP)]

    assert [mark.name for mark in marks] == ["hill", "river", "river"]
    hill, river, section = (field.frame.from_world(mark.point) for mark in marks)
    np.testing.assert_allclose(hill, (*DRY, ground[0]), atol=1e-3)
    np.testing.assert_allclose(river, (*DEEP, ground[1] + 2.0), atol=1e-2)
    np.testing.assert_allclose(section[:2], (1300.0, 2200.0))
    assert [(line.vertices, line.style) for line in inputs(flight).lines] == [(BEND, LineStyle.SECTION)]
    flight.do(SetOption("show_gauges", False))
    assert (inputs(flight).marks, inputs(flight).lines) == ((), ())


def test_a_gauge_goes_before_a_section_of_its_name_unless_the_kind_says_otherwise(flight: Flight) -> None:
    watch(flight)
    for command, kind in ((ShowSeries("river"), "gauge"), (ShowSeries("river", "section"), "section")):
        flight.do(command)
        assert flight.app.gauges.chosen == PlaceRow("river", kind)
    assert [mark.is_chosen for mark in inputs(flight).marks] == [False, False, True]
    with pytest.raises(CommandError, match="'nowhere' is no gauge or section; known are 'hill', 'river'"):
        flight.do(ShowSeries("nowhere"))
    assert flight.app.gauges.chosen == PlaceRow("river", "section")
    flight.do(ShowSeries(None))
    assert flight.app.gauges.chosen is None


def test_a_click_takes_the_mark_and_one_beside_it_the_ground(flight: Flight) -> None:
    watch(flight)
    flight.do(ProbeAt(DEEP[0] + GRID.dx, DEEP[1]))
    assert flight.app.gauges.chosen == PlaceRow("river", "gauge")
    assert flight.app.pointing.probe_at is None
    beside = (DEEP[0] + 15.0 * GRID.dx, DEEP[1])
    flight.do(ProbeAt(*beside))
    assert flight.app.gauges.chosen is None
    assert flight.app.pointing.probe_at == beside


def test_too_many_marks_are_left_out_but_for_the_chosen_one(flight: Flight) -> None:
    watch(flight, MOST_MARKS - 1)
    assert len(inputs(flight).marks) == MOST_MARKS
    watch(flight, MOST_MARKS)
    assert inputs(flight).marks == ()
    assert inputs(flight).lines == ()
    flight.do(ShowSeries("hill"))
    assert [mark.name for mark in inputs(flight).marks] == ["hill"]
