import pytest

from protocol import GaugePlace, InvalidMessage, Places, SectionPlace, limits, pack, unpack_server


def test_the_largest_places_pass() -> None:
    line = tuple((float(k), 0.5 + k) for k in range(limits.MAX_PLACE_POINTS))
    gauges = tuple(GaugePlace(f"gauge {k}", float(k), 0.0) for k in range(limits.MAX_PLACES))
    sections = tuple(SectionPlace(f"section {k}", line) for k in range(limits.MAX_PLACES))
    told = Places("r", gauges, sections)
    packed = pack(told)

    assert len(packed) < limits.OUTBOUND_MAX_BYTES
    assert unpack_server(packed) == told


@pytest.mark.parametrize(
    "places",
    [
        Places("r", (GaugePlace("g", 0.0, 0.0),) * (limits.MAX_PLACES + 1)),
        Places("r", (), (SectionPlace("s", ((0.0, 0.0),)),)),
        Places("r", (), (SectionPlace("s", ((0.0, 0.0),) * (limits.MAX_PLACE_POINTS + 1)),)),
        Places("r", (GaugePlace("g", 2e9, 0.0),)),
    ],
    ids=["too many", "no line", "too long a line", "far away"],
)
def test_more_or_other_places_are_refused(places: Places) -> None:
    with pytest.raises(InvalidMessage):
        unpack_server(pack(places))
