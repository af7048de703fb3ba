import msgspec
import pytest
from msgspec import DecodeError

from protocol import GaugePlace, GridInfo, SectionPlace
from solver_service.runs.case_facts import CaseFacts


def test_facts_come_back_from_the_store_as_they_were() -> None:
    grid = GridInfo(3, 4, 30.0, 740_010.0, 4_014_000.0, "EPSG:32616", "NGVD29", 300.0)
    facts = CaseFacts(grid, True, 1e-3, "USGS", "public domain", "2026-11-22T00:00:00+00:00")

    assert CaseFacts.unpack(facts.pack()) == facts
    gauges, sections = (GaugePlace("g", 1.0, 2.0),), (SectionPlace("s", ((0.0, 0.0), (3.0, 4.0))),)
    watched = msgspec.structs.replace(facts, gauges=gauges, sections=sections)
    assert CaseFacts.unpack(watched.pack()) == watched != facts


def test_facts_from_before_places_were_kept_have_none() -> None:
    facts = CaseFacts(GridInfo(3, 4, 30.0, 0.0, 0.0), False, 1e-3)
    stored = msgspec.to_builtins(facts)
    del stored["gauges"], stored["sections"]

    assert CaseFacts.unpack(msgspec.msgpack.encode(stored)) == facts


def test_torn_facts_are_refused() -> None:
    packed = CaseFacts(GridInfo(3, 4, 30.0, 0.0, 0.0), False, 1e-3).pack()

    with pytest.raises(DecodeError):
        CaseFacts.unpack(packed[:-1])
