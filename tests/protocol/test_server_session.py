import numpy as np
import pytest

import protocol as p
from protocol import limits
from tests.protocol.connection import Connection, connect, welcome

LAYOUT = p.BlockLayout(40, 50)


def frames(count: int, group: int = 3) -> list[bytes]:
    encoder = p.FrameEncoder(LAYOUT, group=group)
    return [encoder.encode("r", k, 10.0 * k, 0, np.full((40, 50), 1.0 + k)) for k in range(count)]


def test_the_first_message_is_hello() -> None:
    with pytest.raises(p.SequenceError, match="hello"):
        p.ServerSession().receive(p.pack(p.ListRuns(1)))


def test_hello_opens_the_session_once_it_is_welcomed() -> None:
    server = p.ServerSession()
    hello = p.Hello(client="viewer", versions=("fev.v7", "fev.v1"))
    assert server.receive(p.pack(hello)) == [hello]
    assert (server.hello, server.version, server.state) == (hello, "fev.v1", p.SessionState.CONNECTING)
    server.send(welcome())
    assert server.state is p.SessionState.OPEN


def test_a_client_of_another_version_is_refused() -> None:
    with pytest.raises(p.VersionMismatch):
        p.ServerSession().receive(p.pack(p.Hello(protocol="fev.v2", versions=("fev.v2",))))


def test_commands_before_the_welcome_are_refused() -> None:
    server = p.ServerSession()
    server.receive(p.pack(p.Hello()))
    with pytest.raises(p.SequenceError):
        server.receive(p.pack(p.ListRuns(1)))


def test_a_second_hello_is_refused() -> None:
    with pytest.raises(p.SequenceError):
        connect().server.receive(p.pack(p.Hello()))


def test_nothing_but_a_refusal_is_sent_before_the_welcome() -> None:
    server = p.ServerSession()
    with pytest.raises(p.SequenceError):
        server.send(welcome())
    with pytest.raises(p.SequenceError):
        server.send(p.Notice("info", "Hi."))
    assert server.send(p.Error(None, "unauthorised", "No."))


@pytest.mark.parametrize("used", [5, 4])
def test_an_id_that_is_not_above_the_last_is_refused(used: int) -> None:
    server = connect().server
    server.receive(p.pack(p.ListRuns(5)))
    with pytest.raises(p.SequenceError, match="not above"):
        server.receive(p.pack(p.ListRuns(used)))


@pytest.mark.parametrize(
    "answer", [p.Ack(1), p.Error(1, "busy", "Not now."), p.RunList(1, ()), p.CaseList(1, ())]
)
def test_a_command_is_answered_exactly_once(answer: p.ServerMessage) -> None:
    server = connect().server
    server.receive(p.pack(p.ListRuns(1)))
    assert server.pending == {1}
    server.send(answer)
    assert not server.pending
    with pytest.raises(p.SequenceError):
        server.send(answer)


def test_more_unanswered_commands_than_allowed_are_refused_with_a_fatal_error() -> None:
    server = connect().server
    for number in range(limits.MAX_PENDING_COMMANDS):
        server.receive(p.pack(p.ListRuns(number + 1)))
    with pytest.raises(p.Overloaded) as caught:
        server.receive(p.pack(p.ListRuns(1000)))
    assert (caught.value.close_code, caught.value.fatal) == (1013, True)


def test_an_invalid_command_is_refused_under_its_id_once() -> None:
    server = connect().server
    with pytest.raises(p.InvalidMessage) as caught:
        server.receive(p.pack(p.Credit(1))[:-1] + b"\x00")
    assert p.unpack_server(server.refuse(caught.value)[0]).id is None  # type: ignore[union-attr]
    with pytest.raises(p.UnknownMessage) as unknown:
        server.receive(p.pack(p.StopRun(3, "r")).replace(b"stop_run", b"stop_fun"))
    (data,) = server.refuse(unknown.value)
    assert p.unpack_server(data) == p.Error(3, "unknown_message", str(unknown.value))
    assert not server.pending
    with pytest.raises(p.SequenceError):
        server.receive(p.pack(p.ListRuns(3)))
    server.receive(p.pack(p.ListRuns(4)))


def test_a_refused_duplicate_gets_an_error_without_id() -> None:
    server = connect().server
    server.receive(p.pack(p.ListRuns(5)))
    with pytest.raises(p.UnknownMessage) as caught:
        server.receive(p.pack(p.StopRun(4, "r")).replace(b"stop_run", b"stop_fun"))
    (data,) = server.refuse(caught.value)
    assert p.unpack_server(data) == p.Error(None, "unknown_message", str(caught.value))
    assert server.pending == {5}


def test_a_refused_message_does_not_use_up_the_answer_of_a_pending_command() -> None:
    server = connect().server
    server.receive(p.pack(p.ListRuns(5)))
    with pytest.raises(p.UnknownMessage) as caught:
        server.receive(p.pack(p.StopRun(5, "r")).replace(b"stop_run", b"stop_fun"))
    (data,) = server.refuse(caught.value)
    assert p.unpack_server(data) == p.Error(None, "unknown_message", str(caught.value))
    assert server.send(p.RunList(5, ()))


def test_a_refusal_can_be_said_before_hello() -> None:
    server = p.ServerSession()
    with pytest.raises(p.MalformedMessage) as caught:
        server.receive(b"\xc1")
    (data,) = server.refuse(caught.value)
    assert p.unpack_server(data) == p.Error(None, "malformed", str(caught.value))


def test_a_message_larger_than_a_client_accepts_is_not_sent() -> None:
    server = connect().server
    server.receive(p.pack(p.ListCases(1)))
    case = p.CaseSummary("c", "t", False, 2, 2, 1.0, 1.0, 1.0, "x" * 2000, "x" * 2000)
    with pytest.raises(p.TooLarge):
        server.send(p.CaseList(1, (case,) * 600))
    assert server.pending == {1}


def test_a_subscription_takes_effect_with_its_ack() -> None:
    connection = connect()
    server = connection.server
    command = p.Subscribe(1, "r", 4, "live", 3)
    connection.ask(command)
    assert not server.can_send_frame
    connection.tell(p.Ack(1))
    assert (server.subscription, server.credit, server.can_send_frame) == (command, 3, True)


def test_a_refused_subscription_changes_nothing() -> None:
    connection = connect()
    connection.subscribe(credit=2)
    before = connection.server.subscription
    connection.ask(p.Subscribe(7, "nowhere", 0, "live", 9))
    connection.tell(p.Error(7, "unknown_run", "There is no run 'nowhere'."))
    assert (connection.server.subscription, connection.server.credit) == (before, 2)


def test_seek_goes_on_from_another_frame_in_replay_order_and_keeps_the_credit() -> None:
    connection = connect()
    connection.subscribe(credit=2, mode="live")
    connection.ask(p.Credit(3))
    connection.ask(p.Seek(8, "r", 40))
    connection.tell(p.Ack(8))
    subscription = connection.server.subscription
    assert subscription is not None
    assert (subscription.from_index, subscription.mode, connection.server.credit) == (40, "replay", 5)


def test_seek_without_a_subscription_sends_nothing() -> None:
    connection = connect()
    connection.ask(p.Seek(8, "r", 40))
    connection.tell(p.Ack(8))
    assert not connection.server.can_send_frame


def test_unsubscribe_voids_the_credit() -> None:
    connection = connect()
    connection.subscribe()
    connection.ask(p.Unsubscribe(8))
    connection.tell(p.Ack(8))
    connection.ask(p.Credit(5))
    assert (connection.server.subscription, connection.server.credit) == (None, 0)


def test_a_subscription_moves_to_the_child_with_its_mode_and_credit() -> None:
    connection = connect()
    connection.subscribe(credit=2, mode="live")
    connection.server.move_to("child", 17)
    subscription = connection.server.subscription
    assert subscription is not None
    assert (subscription.run, subscription.from_index, subscription.mode) == ("child", 17, "live")
    assert connection.server.credit == 2


def test_a_session_without_a_subscription_does_not_move() -> None:
    server = connect().server
    server.move_to("child", 17)
    assert server.subscription is None


def test_credit_does_not_pile_up_beyond_its_limit() -> None:
    connection = connect()
    connection.subscribe()
    for _ in range(3):
        connection.ask(p.Credit(limits.MAX_CREDIT))
    assert connection.server.credit == limits.MAX_CREDIT


def test_each_frame_takes_one_credit_however_many_parts_it_has() -> None:
    connection = Connection(server=p.ServerSession(part_bytes=64))
    connection.server.receive(connection.client.open())
    connection.tell(welcome())
    connection.subscribe(credit=2)
    assert len(connection.server.send_frame(frames(1)[0])) > 1
    assert connection.server.credit == 1


def test_a_delta_is_sent_only_after_its_key_frame() -> None:
    connection = connect()
    connection.subscribe()
    stored = frames(5)
    assert connection.server.needed_key("r", 3) == 3
    with pytest.raises(p.SequenceError, match="key frame 3"):
        connection.server.send_frame(stored[4])
    connection.server.send_frame(stored[3])
    assert connection.server.needed_key("r", 3) is None
    connection.server.send_frame(stored[4])
    assert connection.server.credit == 0


def test_a_key_frame_ahead_of_its_delta_may_overdraw_the_credit_by_one() -> None:
    connection = connect()
    connection.subscribe(credit=1)
    stored = frames(5)
    connection.server.send_frame(stored[3])
    connection.server.send_frame(stored[4])
    assert connection.server.credit == -1
    connection.ask(p.Credit(1))
    assert not connection.server.can_send_frame
    connection.ask(p.Credit(1))
    assert connection.server.can_send_frame


def test_the_key_frames_a_client_no_longer_keeps_are_needed_again() -> None:
    connection = connect()
    connection.subscribe(credit=64)
    stored = frames(3 * (limits.KEY_FRAMES_KEPT + 1))
    for data in stored[::3]:
        connection.server.send_frame(data)
    assert connection.server.needed_key("r", 0) == 0
    assert [index for _, index in connection.server.keys_sent] == [3, 6, 9, 12]
    connection.server.send_frame(stored[3])
    assert [index for _, index in connection.server.keys_sent] == [6, 9, 12, 3]


def test_a_frame_message_is_sent_as_its_stored_bytes_are() -> None:
    connection = connect()
    connection.subscribe()
    data = frames(1)[0]
    assert connection.server.send(p.unpack_frame(data)) == [data]
    assert connection.server.credit == 1


def test_after_the_end_nothing_is_sent_or_received() -> None:
    server = connect().server
    server.close()
    for attempt in (
        lambda: server.receive(p.pack(p.ListRuns(1))),
        lambda: server.send(p.Notice("info", "Hi.")),
        lambda: server.send_frame(frames(1)[0]),
    ):
        with pytest.raises(p.SequenceError):
            attempt()
