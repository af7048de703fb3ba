"""What the websocket refuses, and with which words; against a real service process."""

import asyncio
import time
from typing import Any

import msgpack
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

import protocol
from bench.service_process import ServiceProcess
from solver_service.web import stream


def opened(service: ServiceProcess, token: str | None = None, **options: Any) -> ClientConnection:
    headers = {"Authorization": f"Bearer {token}"} if token is not None else {}
    options.setdefault("subprotocols", [protocol.PROTOCOL_VERSION])
    return connect(service.url, additional_headers=headers, compression=None, **options)


def closed(connection: ClientConnection) -> tuple[list[protocol.ServerMessage], int, str]:
    """What came before the close, its code and its reason."""
    messages: list[protocol.ServerMessage] = []

    def receive_all() -> None:
        while True:
            data = connection.recv(timeout=15.0)
            assert isinstance(data, bytes)
            messages.append(protocol.unpack_server(data))

    with pytest.raises(ConnectionClosed) as end:
        receive_all()
    close = end.value.rcvd
    assert close is not None
    return messages, close.code, close.reason


def said_hello(service: ServiceProcess, connection: ClientConnection) -> protocol.ClientSession:
    session = protocol.ClientSession("test")
    connection.send(session.open())
    data = connection.recv(timeout=5.0)
    assert isinstance(data, bytes)
    assert isinstance(session.receive(data)[0], protocol.Welcome)
    return session


@pytest.mark.parametrize(
    ("status", "options"),
    [
        (400, {"subprotocols": None}),
        (400, {"subprotocols": ["fev.v9"]}),
        (401, {"token": "wrong-token-wrong-token"}),
        (403, {"origin": "https://evil.example"}),
    ],
)
def test_a_stranger_is_refused_before_the_connection_is_accepted(
    service: ServiceProcess, status: int, options: dict[str, Any]
) -> None:
    with pytest.raises(InvalidStatus) as refusal, opened(service, **options):
        pass
    assert refusal.value.response.status_code == status
    assert refusal.value.response.body


def test_the_token_may_come_in_the_hello_for_browsers(service: ServiceProcess) -> None:
    with opened(service, origin="https://map.example") as connection:  # type: ignore[arg-type]
        assert connection.subprotocol == protocol.PROTOCOL_VERSION
        session = protocol.ClientSession("browser", token=service.token)
        connection.send(session.open())
        data = connection.recv(timeout=5.0)
        assert isinstance(data, bytes)
        assert isinstance(session.receive(data)[0], protocol.Welcome)


@pytest.mark.parametrize("token", [None, "wrong-token-wrong-token"])
def test_a_hello_with_the_wrong_token_is_told_and_closed(service: ServiceProcess, token: str | None) -> None:
    with opened(service) as connection:
        connection.send(protocol.pack(protocol.Hello(token=token)))
        messages, code, reason = closed(connection)
    assert code == 1008
    assert "token" in reason
    assert [message.code for message in messages if isinstance(message, protocol.Error)] == ["wrong_token"]


def test_whoever_says_nothing_is_closed_after_five_seconds(service: ServiceProcess) -> None:
    begun = time.monotonic()
    with opened(service, service.token) as connection:
        messages, code, reason = closed(connection)
    assert code == 1008
    assert "hello" in reason
    assert 4.5 < time.monotonic() - begun < 8.0
    assert len(messages) == 1


@pytest.mark.parametrize(
    ("data", "code", "word"),
    [
        (b"\xc1", 1007, "reserved"),
        (b"\x93\x01\x02\x03", 1007, "map"),
        (msgpack.packb({"op": "list_runs", "id": 1}), 1002, "hello"),
    ],
)
def test_a_first_message_that_is_no_hello_closes_with_its_code(
    service: ServiceProcess, data: bytes, code: int, word: str
) -> None:
    with opened(service, service.token) as connection:
        connection.send(data)
        messages, found, reason = closed(connection)
    assert found == code
    assert word in reason
    assert isinstance(messages[0], protocol.Error)


def test_an_unknown_operation_is_answered_and_the_connection_goes_on(service: ServiceProcess) -> None:
    with opened(service, service.token) as connection:
        session = said_hello(service, connection)
        connection.send(msgpack.packb({"op": "launch_missiles", "id": 1}))
        data = connection.recv(timeout=5.0)
        assert isinstance(data, bytes)
        answer = protocol.unpack_server(data)
        assert isinstance(answer, protocol.Error)
        assert (answer.id, answer.code) == (1, "unknown_message")
        session.next_id()
        connection.send(session.send(protocol.ListCases(id=session.next_id())))
        data = connection.recv(timeout=5.0)
        assert isinstance(data, bytes)
        assert isinstance(session.receive(data)[0], protocol.CaseList)


def test_an_oversized_message_closes_with_1009(service: ServiceProcess) -> None:
    with opened(service, service.token) as connection:
        said_hello(service, connection)
        connection.send(b"x" * (protocol.limits.INBOUND_MAX_BYTES + 1))
        _, code, _ = closed(connection)
    assert code == 1009


def test_text_is_refused(service: ServiceProcess) -> None:
    with opened(service, service.token) as connection:
        said_hello(service, connection)
        connection.send("hello?")
        messages, code, _ = closed(connection)
    assert code == 1003
    assert isinstance(messages[-1], protocol.Error)


def test_a_message_that_is_no_number_where_one_is_due_changes_nothing(service: ServiceProcess) -> None:
    with opened(service, service.token) as connection:
        said_hello(service, connection)
        connection.send(
            msgpack.packb({"op": "start_run", "id": 1, "case": "dam-break", "duration": float("nan")})
        )
        data = connection.recv(timeout=5.0)
        assert isinstance(data, bytes)
        answer = protocol.unpack_server(data)
        assert isinstance(answer, protocol.Error)
        assert answer.code == "invalid_message"


def test_a_connection_that_takes_nothing_or_was_closed_below_is_over_and_no_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async def closed_below() -> None:
        raise RuntimeError("Unexpected ASGI message 'websocket.send', after sending 'websocket.close'.")

    monkeypatch.setattr(stream, "SEND_TIMEOUT_S", 0.05)
    for sending in (closed_below(), asyncio.sleep(60.0)):
        with pytest.raises(stream.ConnectionEnded):
            asyncio.run(stream.put_through(sending))
    asyncio.run(stream.put_through(asyncio.sleep(0.0)))
