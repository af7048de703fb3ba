import pytest

from viewer.units import METRIC, UNITS, US


def test_a_foot_is_the_international_one() -> None:
    assert US.shown(0.3048) == 1.0
    assert US.metres(10.0) == pytest.approx(3.048)
    assert METRIC.shown(2.5) == METRIC.metres(2.5) == 2.5


def test_depths_and_levels_keep_two_decimals() -> None:
    assert METRIC.length_text(1234.567) == "1,234.57 m"
    assert US.length_text(0.762) == "2.50 ft"


def test_a_long_distance_is_written_in_the_larger_unit() -> None:
    assert [METRIC.distance_text(x) for x in (999.0, 1000.0, 12_345.0)] == ["999 m", "1.00 km", "12.35 km"]
    assert [US.distance_text(x) for x in (30.48, 1609.344)] == ["100 ft", "1.00 mi"]


def test_areas_volumes_speeds_and_discharges_have_their_units() -> None:
    assert METRIC.area_text(2.5e6) == "2.50 km\u00b2"
    assert METRIC.area_text(400.0) == "400 m\u00b2"
    assert US.area_text(4046.8564224) == "1.00 acres"
    assert US.area_text(0.3048**2 * 90.0) == "90 ft\u00b2"
    assert METRIC.volume_text(12_345.6) == "12,346 m\u00b3"
    assert US.volume_text(0.3048**3 * 1000.0) == "1,000 ft\u00b3"
    assert METRIC.speed_text(1.5) == "1.50 m/s"
    assert US.speed_text(0.3048) == "1.00 ft/s"
    assert METRIC.discharge_text(12.34) == "12.3 m\u00b3/s"
    assert US.discharge_text(0.3048**3 * 50.0) == "50.0 ft\u00b3/s"


def test_every_system_is_found_by_its_name() -> None:
    assert all(UNITS[name].name == name for name in UNITS)
    assert set(UNITS) == {"metric", "us"}
