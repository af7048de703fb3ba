from collections.abc import Iterator

import msgspec
import pytest

from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import INTERVAL, TinyService
from viewer.app.water_look import WaterLook
from viewer.commands import Pause, Seek, SetOption
from viewer.units import METRIC
from viewer.world import WaterColour


@pytest.fixture
def bare() -> Iterator[Flight]:
    service = TinyService(computed=20)
    service.channels = ()
    made = Flight(service)
    made.have_frames(20)
    yield made
    made.close()


def look_of(flight: Flight) -> WaterLook:
    return flight.app.water.look


def colour(flight: Flight, value: str, time: float) -> None:
    flight.do(Pause(), Seek(time), SetOption("water_colour", value))
    flight.settle()
    flight.until(lambda: look_of(flight).colouring is not None and look_of(flight).note == "")


def test_depth_needs_no_channel_and_natural_water_no_classes(flight: Flight) -> None:
    colour(flight, "depth", 5 * INTERVAL)
    look = look_of(flight)

    assert look.colouring is not None
    assert look.legend()[0].text == "< 0.15"
    assert look.legend()[0].colour == look.colouring.scale.colours[0]
    assert flight.service.channels_asked == []
    flight.do(SetOption("water_colour", "natural"))
    flight.until(lambda: look.colouring is None)
    assert look.legend() == ()


def test_speeds_are_those_of_both_frames_on_the_picture(flight: Flight) -> None:
    colour(flight, "speed", 7.4 * INTERVAL)
    colouring = look_of(flight).colouring

    assert colouring is not None
    assert [field.values.max() for field in colouring.fields] == pytest.approx([0.7, 0.8], abs=1e-3)


def test_while_a_velocity_is_on_its_way_the_nearest_one_stands_in_and_says_so(flight: Flight) -> None:
    colour(flight, "hazard", 7.0 * INTERVAL)
    flight.service.channels = ()  # from now on none comes
    flight.do(Seek(15 * INTERVAL))
    flight.until(lambda: look_of(flight).note != "")
    colouring = look_of(flight).colouring

    assert colouring is not None
    assert colouring.fields[0].values.max() == pytest.approx(1.0, abs=0.301)
    assert "the picture has that of 00:01:" in look_of(flight).note


@pytest.mark.parametrize(
    ("value", "highest"), [("max_depth", 2.0), ("max_speed", 1.9), ("max_hazard", 2.5), ("arrival", 190.0)]
)
def test_maxima_come_in_one_field_for_the_whole_run(flight: Flight, value: str, highest: float) -> None:
    colour(flight, value, 19 * INTERVAL)
    colouring = look_of(flight).colouring

    assert colouring is not None
    assert len(colouring.fields) == 1
    assert colouring.fields[0].values.max() == pytest.approx(highest, abs=0.01 * highest)
    assert colouring.fields[0].values.min() == -1.0


def test_a_run_without_channels_says_so_and_stays_natural(bare: Flight) -> None:
    bare.do(SetOption("water_colour", "speed"))
    bare.until(lambda: look_of(bare).note != "")
    status = bare.app.fresh_status()

    assert look_of(bare).colouring is None
    assert status.water_note == "This run does not keep the channel velocity."
    assert status.water_colours == ("natural", "depth")
    bare.do(SetOption("water_colour", "arrival"))
    bare.until(lambda: "maxima" in look_of(bare).note)
    assert bare.app.fresh_status().water_note == "This run does not keep the channel maxima."


def test_arrival_is_told_in_clock_time_where_the_case_has_a_clock(flight: Flight) -> None:
    shown = flight.shown
    look = look_of(flight)
    plain = look._scale_of(shown, WaterColour.ARRIVAL, METRIC)
    shown.info = msgspec.structs.replace(shown.info, start_time="2024-06-01T12:00:00+02:00")
    clock = look._scale_of(shown, WaterColour.ARRIVAL, METRIC)

    assert plain is not None
    assert clock is not None
    assert plain.labels[0] == "before 1 min"
    assert clock.labels[:2] == ("before 12:01", "12:01 - 12:02")
