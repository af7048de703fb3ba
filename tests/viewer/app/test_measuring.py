import pytest

from tests.viewer.app.conftest import Flight
from viewer.app.measuring import Measuring
from viewer.commands import (
    AddMeasurePoint,
    BeginMeasure,
    CommandError,
    EndMeasure,
    MoveHover,
    Play,
    SetOption,
)
from viewer.render import LineStyle


def test_a_line_is_measured_and_drawn_and_closed_to_an_area(flight: Flight) -> None:
    flight.do(BeginMeasure(), AddMeasurePoint(1250.0, 2350.0), AddMeasurePoint(1350.0, 2350.0))
    assert flight.app.fresh_status().measured.startswith("100 m, ")
    assert "within" not in flight.app.fresh_status().measured
    flight.do(MoveHover(1350.0, 2400.0))
    inputs = flight.app.frame_inputs()

    assert "within it 2,500 m\u00b2" in flight.app.fresh_status().measured
    assert inputs is not None
    assert inputs.edits is not None
    (line,) = inputs.edits.lines
    assert line.style is LineStyle.MEASURE
    assert line.vertices == (
        (1250.0, 2350.0),
        (1350.0, 2350.0),
        (1350.0, 2400.0),
        (1250.0, 2350.0),
    )
    assert inputs.hud is not None
    assert "within it" in inputs.hud.detail


def test_it_is_measured_in_the_units_chosen(flight: Flight) -> None:
    flight.do(
        SetOption("units", "us"),
        BeginMeasure(),
        AddMeasurePoint(1250.0, 2350.0),
        AddMeasurePoint(1280.48, 2350.0),
    )

    assert flight.app.fresh_status().measured.startswith("100 ft, ")


def test_put_away_nothing_is_left(flight: Flight) -> None:
    flight.do(BeginMeasure(), AddMeasurePoint(1250.0, 2350.0), AddMeasurePoint(1350.0, 2350.0), EndMeasure())
    inputs = flight.app.frame_inputs()

    assert flight.app.fresh_status().measured == ""
    assert not flight.app.fresh_status().is_measuring
    assert inputs is not None
    assert inputs.edits is None


def test_a_double_click_sets_one_point(flight: Flight) -> None:
    flight.do(BeginMeasure(), AddMeasurePoint(1250.0, 2350.0), AddMeasurePoint(1250.0, 2350.0))

    assert flight.app.measuring.points == [(1250.0, 2350.0)]


def test_what_makes_no_sense_is_refused(flight: Flight) -> None:
    with pytest.raises(CommandError, match="BeginMeasure first"):
        flight.do(AddMeasurePoint(1250.0, 2350.0))
    flight.do(BeginMeasure())
    with pytest.raises(CommandError, match="outside of the terrain"):
        flight.do(AddMeasurePoint(-1e6, 2350.0))
    with pytest.raises(CommandError, match="no run is shown"):
        Measuring().carry_out(BeginMeasure(), None)
    assert not Measuring().carry_out(Play(), None)
