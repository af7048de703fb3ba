"""The working forcing on a tiny service: wishes become lists, lists become branches."""

from pathlib import Path

import pytest

import protocol
from tests.viewer.app.conftest import Flight
from tests.viewer.tiny_service import ITEMS
from viewer.app.forcing_work import forcing_rows
from viewer.commands import ChangeForcing, CommandError, Recalculate, ResetForcing, Seek, StartRun
from viewer.view_status import ForcingRow


def rows(flight: Flight) -> dict[str, ForcingRow]:
    flight.until(lambda: bool(flight.app.fresh_status().forcing))
    return {row.id: row for row in flight.app.fresh_status().forcing}


def test_the_items_of_the_case_are_told_in_words(flight: Flight) -> None:
    found = rows(flight)

    assert list(found) == ["spring", "sea", "rain", "dam"]
    assert found["spring"].case_text == "2 to 5 m3/s, highest at 00:01:00"
    assert found["sea"].case_text == "1.5 m"
    assert found["rain"].case_text == "none"
    assert found["dam"].case_text == "at 00:02:00"
    assert not any(row.is_changed or row.is_pending for row in found.values())


def test_each_wish_changes_its_item_and_leaves_the_others(flight: Flight, tmp_path: Path) -> None:
    rows(flight)
    (tmp_path / "q.csv").write_text("time_s,q\n0,1\n60,9\n")
    app = flight.app
    app.carry_out(ChangeForcing("spring", factor=2.0))
    app.carry_out(ChangeForcing("spring", series_file=str(tmp_path / "q.csv")))
    app.carry_out(ChangeForcing("sea", offset=0.5))
    app.carry_out(ChangeForcing("dam", start="never"))
    run = flight.service.runs["run-1"]
    flight.until(lambda: len(run.forcing) == 3 and app.control.forcing.changes("run-1") == run.forcing)

    series = protocol.ForcingSeries((0.0, 60.0), (1.0, 9.0))
    assert set(run.forcing) == {
        protocol.ForcingChange("spring", 2.0, series=series),
        protocol.ForcingChange("sea", offset=0.5),
        protocol.ForcingChange("dam", start_time="never"),
    }
    found = rows(flight)
    assert found["spring"].series_text == "1 to 9 m3/s, highest at 00:01:00"
    assert found["dam"].start == "never"
    assert [row.id for row in found.values() if row.is_pending] == ["spring", "sea", "dam"]


def test_a_change_that_is_taken_back_leaves_nothing(flight: Flight) -> None:
    rows(flight)
    app, run = flight.app, flight.service.runs["run-1"]
    app.carry_out(ChangeForcing("spring", factor=2.0))
    app.carry_out(ChangeForcing("dam", start=200.0))
    app.carry_out(ChangeForcing("spring", factor=1.0))
    assert [change.id for change in app.control.forcing.changes("run-1")] == ["dam"]
    app.carry_out(ChangeForcing("sea", offset=0.1))
    app.carry_out(ResetForcing("dam"))
    assert [change.id for change in app.control.forcing.changes("run-1")] == ["sea"]
    app.carry_out(ResetForcing())
    flight.until(lambda: run.info.forcing_revision == 6)
    assert run.forcing == ()


def test_recalculate_takes_the_forcing_along_and_the_branch_shows_it_as_computed(flight: Flight) -> None:
    rows(flight)
    flight.have_frames(10)
    app = flight.app
    app.carry_out(ChangeForcing("spring", factor=2.0))
    app.carry_out(Seek(50.0))
    app.carry_out(Recalculate())  # before the change is confirmed
    flight.until(lambda: flight.shown.run == "run-2")
    assert flight.service.runs["run-2"].applied == (protocol.ForcingChange("spring", 2.0),)
    found = rows(flight)
    assert (found["spring"].is_changed, found["spring"].is_pending) == (True, False)


def test_a_refused_change_is_told_and_forgotten(flight: Flight) -> None:
    rows(flight)
    flight.app.carry_out(ChangeForcing("spring", factor=13.0))
    assert rows(flight)["spring"].factor == 13.0
    flight.until(lambda: rows(flight)["spring"].factor == 1.0)
    assert "Thirteen is refused" in flight.app.message


def test_what_does_not_fit_the_case_never_leaves(flight: Flight) -> None:
    rows(flight)
    for command, told in (
        (ChangeForcing("lake", factor=2.0), "no forcing 'lake'; there are spring, sea"),
        (ChangeForcing("spring", factor=100.0), "comes to 200 m3/s"),
        (ChangeForcing("sea", factor=2.0), "'offset' or a 'series'"),
        (ChangeForcing("dam", start="later"), "not 'later'"),
    ):
        with pytest.raises((CommandError, protocol.ForcingError), match=told):
            flight.app.carry_out(command)
    assert flight.service.runs["run-1"].info.forcing_revision == 0


def test_a_run_starts_with_the_working_forcing_of_the_shown_one_of_its_case(flight: Flight) -> None:
    rows(flight)
    flight.app.carry_out(ChangeForcing("sea", offset=0.5))
    flight.app.carry_out(StartRun("tiny", with_forcing=True))
    flight.until(lambda: flight.shown.run == "run-2")
    assert flight.service.runs["run-2"].applied == (protocol.ForcingChange("sea", offset=0.5),)
    with pytest.raises(CommandError, match="not of the case 'other'"):
        flight.app.carry_out(StartRun("other", with_forcing=True))


def test_a_breach_that_waits_for_the_water_is_told_so() -> None:
    item = protocol.ForcingItem("dike", "breach", "s", start_time=60.0, overtopping=True)
    (row,) = forcing_rows(protocol.ForcingChanged("r", 0, (), (), (item,)), ())

    assert row.case_text == "when overtopped, from 00:01:00"
    assert forcing_rows(None, ()) == ()
    assert len(forcing_rows(protocol.ForcingChanged("r", 0, (), (), ITEMS), ())) == len(ITEMS)
