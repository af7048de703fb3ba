"""The connection against a service on a real socket: opening, refusal, loss and return."""

import socket
import time
from collections.abc import Iterator

import pytest

import protocol
from tests.viewer.tiny_service import FRAMES, TOKEN, TinyService, wait_for
from viewer.net import BackOff, ConnectionThread, NotConnected


@pytest.fixture
def service() -> Iterator[TinyService]:
    made = TinyService()
    yield made
    made.close()


@pytest.fixture
def connection(service: TinyService) -> Iterator[ConnectionThread]:
    made = ConnectionThread(service.url, TOKEN, back_off=BackOff(first_s=0.05, longest_s=0.1))
    yield made
    made.close()


def opened(connection: ConnectionThread) -> list[protocol.ClientEvent]:
    connection.start()
    wait_for(lambda: connection.state.phase == "open")
    return connection.mailbox.take_control()


def test_the_welcome_is_the_first_thing_in_the_mailbox(connection: ConnectionThread) -> None:
    assert isinstance(opened(connection)[0], protocol.Welcome)


def test_the_token_travels_in_the_authorization_header(
    service: TinyService, connection: ConnectionThread
) -> None:
    opened(connection)

    assert service.authorizations == [f"Bearer {TOKEN}"]


def test_a_wrong_token_is_refused_for_good(service: TinyService) -> None:
    connection = ConnectionThread(service.url, "wrong", back_off=BackOff(first_s=0.01))
    connection.start()
    wait_for(lambda: connection.state.phase == "refused")

    assert "wrong token" in connection.state.text
    time.sleep(0.1)
    assert len(service.authorizations) == 1
    connection.close()


def test_frames_and_control_messages_go_to_their_own_planes(
    service: TinyService, connection: ConnectionThread
) -> None:
    run = service.add_run().info.run
    opened(connection)
    connection.send(protocol.Subscribe(connection.next_id(), run=run, credit=5))
    frames: list[protocol.Frame] = []
    wait_for(lambda: frames.extend(connection.mailbox.take_frames()) or len(frames) >= 5)

    assert [frame.index for frame in frames] == [0, 1, 2, 3, 4]
    control = connection.mailbox.take_control()
    assert isinstance(control[0], protocol.Ack)
    assert not any(isinstance(message, protocol.Frame) for message in control)


def test_no_more_frames_come_than_credit_was_granted(
    service: TinyService, connection: ConnectionThread
) -> None:
    run = service.add_run().info.run
    opened(connection)
    connection.send(protocol.Subscribe(connection.next_id(), run=run, credit=3))
    time.sleep(0.3)
    assert len(connection.mailbox.take_frames()) == 3
    connection.send(protocol.Credit(2))
    time.sleep(0.3)

    assert len(connection.mailbox.take_frames()) == 2


def test_a_cut_connection_comes_back_and_says_what_it_knew_and_which_session_it_replaces(
    service: TinyService, connection: ConnectionThread
) -> None:
    opened(connection)
    connection.resume_point = protocol.ResumePoint("run-1", 7, 3)
    service.cut()
    wait_for(lambda: len(service.hellos) == 2)
    wait_for(lambda: connection.state.phase == "open")

    assert service.hellos[0].resume is None
    assert service.hellos[1].resume == protocol.ResumePoint("run-1", 7, 3, session="s1")


def test_a_viewer_that_starts_before_the_service_waits_with_an_honest_countdown() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    connection = ConnectionThread(
        f"ws://127.0.0.1:{port}/v1/stream", TOKEN, back_off=BackOff(first_s=2.0, longest_s=2.0, jitter=0.0)
    )
    connection.start()
    wait_for(lambda: connection.state.phase == "waiting")
    state = connection.state

    assert state.attempt == 1
    assert state.retry_at is not None
    sentence = state.sentence(state.retry_at - 2.0)
    assert "nothing listens there" in sentence
    assert sentence.endswith("reconnecting in 2 s (attempt 1)")
    connection.close()


def test_it_connects_when_the_service_comes_later() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    connection = ConnectionThread(
        f"ws://127.0.0.1:{port}/v1/stream", TOKEN, back_off=BackOff(first_s=0.05, longest_s=0.05)
    )
    connection.start()
    wait_for(lambda: connection.state.attempt >= 2)
    service = TinyService(port=port)
    wait_for(lambda: connection.state.phase == "open")

    connection.close()
    service.close()


def test_nothing_can_be_sent_while_there_is_no_connection() -> None:
    connection = ConnectionThread("ws://127.0.0.1:9/v1/stream", None)

    with pytest.raises(NotConnected, match="not connected"):
        connection.send(protocol.Credit(1))


def test_too_many_unanswered_commands_are_refused_here(
    service: TinyService, connection: ConnectionThread
) -> None:
    opened(connection)
    with service.lock:  # the service answers nothing now
        for _ in range(protocol.limits.MAX_PENDING_COMMANDS):
            connection.send(protocol.ListRuns(connection.next_id()))
        with pytest.raises(NotConnected, match="unanswered"):
            connection.send(protocol.ListRuns(connection.next_id()))


@pytest.mark.parametrize("url", ["nonsense", "http://127.0.0.1:1/", "ws://"])
def test_what_is_no_websocket_address_is_refused_in_one_sentence(url: str) -> None:
    connection = ConnectionThread(url, None)
    connection.start()
    wait_for(lambda: connection.state.phase == "refused")

    assert "not a websocket address" in connection.state.text
    connection.close()


def test_closing_twice_leaves_no_thread(service: TinyService, connection: ConnectionThread) -> None:
    opened(connection)
    connection.close()
    connection.close()

    assert connection.state.phase == "closed"
    assert service.computed == FRAMES


def test_a_refused_connection_is_tried_again_when_asked(service: TinyService) -> None:
    connection = ConnectionThread(service.url, "wrong", back_off=BackOff(first_s=0.01))
    connection.start()
    wait_for(lambda: connection.state.phase == "refused")
    connection.retry()
    wait_for(lambda: len(service.authorizations) == 2)
    connection.close()


def test_the_countdown_is_cut_short_when_asked() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    connection = ConnectionThread(f"ws://127.0.0.1:{port}/v1/stream", None, back_off=BackOff(60.0, 60.0))
    connection.start()
    wait_for(lambda: connection.state.phase == "waiting")
    first = connection.state.retry_at
    connection.retry()
    wait_for(lambda: connection.state.phase == "waiting" and connection.state.retry_at != first)

    assert connection.state.attempt == 1  # counted anew
    connection.close()


def test_another_service_takes_the_place_of_the_first(
    service: TinyService, connection: ConnectionThread
) -> None:
    other = TinyService()
    opened(connection)
    connection.resume_point = protocol.ResumePoint("a-run", 3, 1)
    connection.change_service(other.url, TOKEN)
    wait_for(lambda: connection.state.phase == "open" and bool(other.authorizations))

    assert connection.url == other.url
    assert connection.resume_point is None
    assert [hello.resume for hello in other.hellos] == [None]
    assert isinstance(connection.mailbox.take_control()[0], protocol.Welcome)
    assert connection.received_bytes > 0
    other.close()


def test_a_service_that_refuses_can_be_left(service: TinyService) -> None:
    connection = ConnectionThread(service.url, "wrong", back_off=BackOff(first_s=0.01))
    connection.start()
    wait_for(lambda: connection.state.phase == "refused")
    connection.change_service(service.url, TOKEN)
    wait_for(lambda: connection.state.phase == "open")
    connection.close()
