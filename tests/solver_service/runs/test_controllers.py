import pytest

from protocol import ControlChanged, ControlRequested, ServerMessage
from solver_service.errors import RunError
from solver_service.runs.controllers import IDLE_S, Controllers, Session

ANNA, BEN = Session("anna", "fev-viewer 1"), Session("ben")


class Desk:
    def __init__(self) -> None:
        self.now = 0.0
        self.told: list[ServerMessage] = []
        self.controllers = Controllers(self.told.append, lambda: self.now)

    @property
    def holder(self) -> str | None:
        return self.controllers.of("r1").session


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_the_first_who_changes_a_run_controls_it_and_others_are_refused_in_words(desk: Desk) -> None:
    desk.controllers.claim("r1", ANNA)
    desk.controllers.claim("r1", ANNA)
    with pytest.raises(RunError, match=r"run r1 is controlled by session anna \(fev-viewer 1\)"):
        desk.controllers.claim("r1", BEN)
    assert desk.told == [ControlChanged("r1", "anna", "fev-viewer 1")]
    desk.controllers.claim("r2", BEN)
    assert desk.controllers.of("r2").session == "ben"


def test_an_active_controller_is_asked_and_an_idle_one_is_taken_over(desk: Desk) -> None:
    desk.controllers.claim("r1", ANNA)
    desk.now = IDLE_S - 1.0
    with pytest.raises(RunError, match="active 29 s ago; it can be taken over after 30 s"):
        desk.controllers.take("r1", BEN, force=False)
    assert desk.told[-1] == ControlRequested("r1", "ben", "")
    assert desk.holder == "anna"
    desk.now = IDLE_S
    desk.controllers.take("r1", BEN, force=False)
    assert desk.told[-1] == ControlChanged("r1", "ben", "")


def test_a_command_keeps_a_controller_active(desk: Desk) -> None:
    desk.controllers.claim("r1", ANNA)
    desk.now = IDLE_S
    desk.controllers.claim("r1", ANNA)
    with pytest.raises(RunError, match="active 0 s ago"):
        desk.controllers.take("r1", BEN, force=False)


def test_force_takes_over_at_once(desk: Desk) -> None:
    desk.controllers.claim("r1", ANNA)
    desk.controllers.take("r1", BEN, force=True)
    assert desk.holder == "ben"
    with pytest.raises(RunError, match="controlled by session ben"):
        desk.controllers.claim("r1", ANNA)


def test_control_is_handed_over_or_given_up_only_by_who_has_it(desk: Desk) -> None:
    desk.controllers.claim("r1", ANNA)
    with pytest.raises(RunError, match="session ben does not control run r1"):
        desk.controllers.release("r1", BEN, None)
    desk.controllers.release("r1", ANNA, BEN)
    assert desk.holder == "ben"
    desk.controllers.release("r1", BEN, None)
    assert desk.holder is None
    assert desk.told[-1] == ControlChanged("r1")


def test_the_end_of_a_connection_frees_its_runs_and_no_others(desk: Desk) -> None:
    desk.controllers.claim("r1", ANNA)
    desk.controllers.claim("r2", BEN)
    desk.controllers.ended("anna")
    assert desk.holder is None
    assert desk.controllers.of("r2").session == "ben"


def test_a_connection_that_replaces_a_lost_one_has_its_runs(desk: Desk) -> None:
    desk.controllers.claim("r1", ANNA)
    desk.controllers.replaced("anna", BEN)
    desk.controllers.ended("anna")
    assert desk.holder == "ben"


def test_nothing_is_told_where_nothing_changes(desk: Desk) -> None:
    desk.controllers.take("r1", ANNA, force=True)
    desk.controllers.take("r1", ANNA, force=False)
    desk.controllers.ended("ben")
    desk.controllers.forget("r1")
    assert len(desk.told) == 1
    assert desk.holder is None
