import pytest

from protocol import ServerMessage, View, ViewPresented
from protocol.limits import MAX_VIEWS_PER_S
from solver_service.errors import RunError
from solver_service.runs.controllers import Session
from solver_service.runs.presentations import Presentations

ANNA, BEN = Session("anna", "fev-viewer 1"), Session("ben")


def view(time: float) -> View:
    return View("r1", time, 0.0, 0.0, 100.0, 0.0, 45.0)


class Desk:
    def __init__(self) -> None:
        self.now = 0.0
        self.told: list[ServerMessage] = []
        self.presentations = Presentations(self.told.append, lambda: self.now)


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_a_view_is_told_to_all_and_kept_for_those_who_come_later(desk: Desk) -> None:
    desk.presentations.present(ANNA, view(1.0))
    desk.presentations.present(BEN, view(2.0))
    desk.now = 1.0
    desk.presentations.present(ANNA, view(3.0))

    assert desk.told[-1] == ViewPresented("anna", "fev-viewer 1", view(3.0))
    assert {shown.session: shown.view for shown in desk.presentations.current} == {
        "anna": view(3.0),
        "ben": view(2.0),
    }


def test_the_end_is_told_once(desk: Desk) -> None:
    desk.presentations.present(ANNA, view(1.0))
    desk.presentations.present(ANNA, None)
    desk.presentations.present(ANNA, None)
    desk.presentations.ended("anna")

    assert desk.told[1:] == [ViewPresented("anna", "fev-viewer 1", None)]
    assert desk.presentations.current == ()


def test_views_that_come_too_fast_are_refused(desk: Desk) -> None:
    desk.presentations.present(ANNA, view(1.0))
    desk.now = 0.5 / MAX_VIEWS_PER_S
    with pytest.raises(RunError, match=r"session anna .* too fast; 20 a second are allowed"):
        desk.presentations.present(ANNA, view(2.0))
    desk.now = 1.1 / MAX_VIEWS_PER_S
    desk.presentations.present(ANNA, view(2.0))

    assert len(desk.told) == 2
