import msgspec
import pytest

from protocol import ForcingChange, ForcingSeries
from solver_service.runs.forced_course import WorkingForcing, course_of, pack_changes, unpack_changes
from solver_service.runs.lineage import Leg
from solver_service.scenario.forced_model import ForcedFrom
from solver_service.store import ForcingEvent

CHANGES = (
    ForcingChange("spring", 2.0, series=ForcingSeries((0.0, 1.0), (2.0, 3.0))),
    ForcingChange("dam", start_time="never"),
)


def test_changes_survive_their_stored_form() -> None:
    assert unpack_changes(pack_changes(CHANGES)) == CHANGES
    with pytest.raises(msgspec.MsgspecError):
        unpack_changes(b"\x91\x80")


def test_a_list_of_none_is_what_rows_hold_by_default() -> None:
    assert pack_changes(()) == b"\x90"


def test_each_leg_brings_its_changes_at_the_time_of_its_first_frame() -> None:
    legs = (Leg("r1", 0, 0, b"", pack_changes(())), Leg("r2", 6, 1, b"", pack_changes(CHANGES)))
    assert course_of(legs, 5.0) == (ForcedFrom(0.0, ()), ForcedFrom(30.0, CHANGES))


def test_a_working_forcing_is_kept_by_its_last_change() -> None:
    assert WorkingForcing.of(ForcingEvent("r", 3, pack_changes(CHANGES))) == WorkingForcing(3, CHANGES)
    assert WorkingForcing(3, CHANGES).event("child") == ForcingEvent("child", 3, pack_changes(CHANGES))
    assert WorkingForcing().event("child") is None
