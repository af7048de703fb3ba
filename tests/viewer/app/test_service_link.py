import pytest

import protocol
from viewer.app.service_link import ServiceLink
from viewer.net import NotConnected


class Line:
    """Takes what would go to the socket."""

    def __init__(self, is_open: bool = True) -> None:
        self.is_open = is_open
        self.sent: list[protocol.ClientMessage] = []
        self.number = 0

    def next_id(self) -> int:
        self.number += 1
        return self.number

    def send(self, message: protocol.ClientMessage) -> None:
        if not self.is_open:
            raise NotConnected("not connected")
        self.sent.append(message)


@pytest.fixture
def line() -> Line:
    return Line()


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def link(line: Line, said: list[str]) -> ServiceLink:
    return ServiceLink(line, said.append)  # type: ignore[arg-type]


def test_the_answer_reaches_who_asked(link: ServiceLink, line: Line) -> None:
    results: list[object] = []
    link.send(lambda number: protocol.StartRun(number, case="tiny"), "start", results.append)
    link.send(lambda number: protocol.StopRun(number, run="r"), "stop")
    link.handle_ack(protocol.Ack(2))
    link.handle_ack(protocol.Ack(1, {"run": "r1"}))
    link.handle_ack(protocol.Ack(1, {"run": "again"}))

    assert results == [{"run": "r1"}]


def test_a_refusal_is_told_once_and_reaches_who_asked(link: ServiceLink, said: list[str]) -> None:
    refused: list[str] = []
    link.send(lambda number: protocol.StopRun(number, run="r"), "stop the run", refused=refused.append)
    link.handle_error(protocol.Error(1, "refused", "Run 'r' is unknown."))

    assert said == ["stop the run: Run 'r' is unknown."]
    assert refused == ["Run 'r' is unknown."]


def test_what_cannot_leave_is_refused_at_once(said: list[str]) -> None:
    link = ServiceLink(Line(is_open=False), said.append)  # type: ignore[arg-type]

    assert not link.send(lambda number: protocol.StopRun(number, run="r"), "stop the run")
    assert said == ["stop the run: not connected"]
    link.grant(3)
    assert len(said) == 1


def test_after_a_loss_no_answer_is_waited_for(link: ServiceLink, said: list[str]) -> None:
    refused: list[str] = []
    link.send(lambda number: protocol.StopRun(number, run="r"), "stop the run", refused=refused.append)
    link.forget()

    assert "connection was lost" in said[0]
    assert len(refused) == 1


def test_a_complaint_about_the_connection_is_told_as_it_is(link: ServiceLink, said: list[str]) -> None:
    link.handle_error(protocol.Error(None, "wrong_token", "The token is wrong."))

    assert said == ["The token is wrong."]


def test_much_credit_goes_in_shares_the_protocol_allows(link: ServiceLink, line: Line) -> None:
    link.grant(150)

    assert [message.frames for message in line.sent if isinstance(message, protocol.Credit)] == [64, 64, 22]
