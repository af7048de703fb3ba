from protocol import Notice, ServerMessage
from solver_service.runs.audience import Audience


class Ear:
    """A listener that remembers, and may leave when it hears something."""

    def __init__(self, audience: Audience | None = None) -> None:
        self.heard: list[object] = []
        self._leaves = audience

    def announce(self, message: ServerMessage) -> None:
        self.heard.append(message)
        if self._leaves is not None:
            self._leaves.remove(self)

    def frame_stored(self, run: str) -> None:
        self.heard.append(run)


def test_everybody_hears_every_message_until_they_leave() -> None:
    audience, notice = Audience(), Notice("info", "rain")
    first, second = Ear(), Ear()
    audience.add(first)
    audience.add(second)
    audience.announce(notice)
    audience.remove(first)
    audience.frame_stored("r1")

    assert first.heard == [notice]
    assert second.heard == [notice, "r1"]
    assert len(audience) == 1


def test_one_who_leaves_while_listening_keeps_nobody_from_hearing() -> None:
    audience = Audience()
    ears = [Ear(audience), Ear(audience), Ear()]
    for ear in ears:
        audience.add(ear)

    audience.announce(Notice("info", "rain"))

    assert [len(ear.heard) for ear in ears] == [1, 1, 1]
    assert len(audience) == 1


def test_to_leave_twice_is_no_error() -> None:
    audience, ear = Audience(), Ear()
    audience.add(ear)
    audience.remove(ear)
    audience.remove(ear)

    assert len(audience) == 0
