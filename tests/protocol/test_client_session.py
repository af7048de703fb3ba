import msgspec
import numpy as np
import pytest

import protocol as p
from protocol import limits
from tests.protocol.connection import Connection, connect, welcome

GRID = p.BlockLayout(40, 50)


def test_a_session_opens_with_hello_and_welcome() -> None:
    client = p.ClientSession("viewer 1", token="secret")
    resume = p.ResumePoint(run="r", last_index=4, revision=2)
    hello = p.unpack_client(client.open(resume))
    assert hello == p.Hello(client="viewer 1", token="secret", resume=resume)
    assert client.state is p.SessionState.CONNECTING
    assert client.receive(p.pack(welcome())) == [welcome()]
    assert client.state is p.SessionState.OPEN
    assert client.welcome == welcome()


def test_hello_is_said_once() -> None:
    client = p.ClientSession("viewer")
    client.open()
    with pytest.raises(p.SequenceError):
        client.open()


def test_nothing_is_sent_before_the_welcome() -> None:
    client = p.ClientSession("viewer")
    client.open()
    with pytest.raises(p.SequenceError, match="CONNECTING"):
        client.send(p.ListRuns(1))


def test_a_refusal_before_the_welcome_is_handed_on() -> None:
    client = p.ClientSession("viewer")
    client.open()
    refusal = p.Error(None, "unauthorised", "The token is wrong.")
    assert client.receive(p.pack(refusal)) == [refusal]
    assert client.state is p.SessionState.CONNECTING


@pytest.mark.parametrize("message", [p.Ack(1), p.Notice("info", "Hi."), p.RunList(1, ())])
def test_anything_else_before_the_welcome_is_refused(message: p.ServerMessage) -> None:
    client = p.ClientSession("viewer")
    client.open()
    with pytest.raises(p.SequenceError):
        client.receive(p.pack(message))


def test_a_welcome_that_nobody_asked_for_is_refused() -> None:
    with pytest.raises(p.SequenceError):
        p.ClientSession("viewer").receive(p.pack(welcome()))
    with pytest.raises(p.SequenceError):
        connect().client.receive(p.pack(welcome()))


def test_a_welcome_in_another_version_is_refused() -> None:
    client = p.ClientSession("viewer")
    client.open()
    with pytest.raises(p.VersionMismatch):
        client.receive(p.pack(p.Welcome(protocol="fev.v2", server="x", version="0", session="s")))


def test_ids_rise() -> None:
    client = connect().client
    assert [client.next_id() for _ in range(3)] == [1, 2, 3]
    client.send(p.ListRuns(10))
    assert client.next_id() == 11


def test_an_id_is_never_sent_twice() -> None:
    client = connect().client
    client.send(p.ListRuns(5))
    for used in (5, 4):
        with pytest.raises(p.SequenceError, match="not above"):
            client.send(p.ListRuns(used))


@pytest.mark.parametrize(
    "answer", [p.Ack(1), p.Error(1, "busy", "Not now."), p.RunList(1, ()), p.CaseList(1, ())]
)
def test_each_command_is_answered_once(answer: p.ServerMessage) -> None:
    client = connect().client
    client.send(p.ListRuns(client.next_id()))
    assert client.pending == {1: "list_runs"}
    assert client.receive(p.pack(answer)) == [answer]
    assert not client.pending
    with pytest.raises(p.SequenceError, match="not pending"):
        client.receive(p.pack(answer))


def test_an_answer_to_a_command_never_sent_is_refused() -> None:
    with pytest.raises(p.SequenceError, match="99"):
        connect().client.receive(p.pack(p.Ack(99)))


def test_credit_needs_no_answer() -> None:
    client = connect().client
    client.send(p.Credit(1))
    assert not client.pending


def test_too_many_commands_at_once_are_not_sent() -> None:
    client = connect().client
    for _ in range(limits.MAX_PENDING_COMMANDS):
        client.send(p.ListRuns(client.next_id()))
    with pytest.raises(p.Overloaded):
        client.send(p.ListRuns(client.next_id()))
    client.receive(p.pack(p.RunList(1, ())))
    client.send(p.ListRuns(client.next_id()))


def test_a_frame_in_parts_comes_whole(rng: np.random.Generator) -> None:
    connection = Connection(server=p.ServerSession(part_bytes=1000))
    connection.server.receive(connection.client.open())
    connection.tell(welcome())
    connection.subscribe()
    data = p.FrameEncoder(GRID).encode("r", 0, 0.0, 0, rng.random(GRID_SHAPE))
    pieces = connection.server.send_frame(data)
    assert len(pieces) > 2
    assert connection.deliver(pieces) == [p.unpack_frame(data)]


GRID_SHAPE = (GRID.nrows, GRID.ncols)


def test_control_messages_come_between_the_parts_of_a_frame() -> None:
    client = connect().client
    data = p.FrameEncoder(GRID).encode("r", 0, 0.0, 0, np.ones(GRID_SHAPE))
    notice = p.Notice("info", "Hi.")
    assert client.receive(p.pack(p.FramePart("r", 0, 0, 2, data[:50]))) == []
    assert client.receive(p.pack(notice)) == [notice]
    assert client.receive(p.pack(p.FramePart("r", 0, 1, 2, data[50:]))) == [p.unpack_frame(data)]


def test_parts_that_hold_another_frame_are_refused() -> None:
    client = connect().client
    data = p.FrameEncoder(GRID).encode("r", 0, 0.0, 0, np.ones(GRID_SHAPE))
    with pytest.raises(p.InvalidMessage):
        client.receive(p.pack(p.FramePart("r", 5, 0, 1, data)))


def test_parts_that_hold_no_frame_are_refused() -> None:
    for data in (p.pack(p.Ack(1)), b"\xc1", b""):
        with pytest.raises(p.ProtocolError):
            connect().client.receive(p.pack(p.FramePart("r", 5, 0, 1, data)))


def test_a_terrain_comes_whole(rng: np.random.Generator) -> None:
    connection = connect()
    command = p.GetTerrain(connection.client.next_id(), "r")
    connection.ask(command)
    z_b = rng.normal(size=(300, 400)).astype(np.float32)
    connection.tell(p.Ack(command.id))
    events = [event for part in p.encode_terrain(command.id, "r", z_b) for event in connection.tell(part)]
    (received,) = events
    assert isinstance(received, p.TerrainReceived)
    assert (received.id, received.run) == (command.id, "r")
    np.testing.assert_array_equal(received.z_b, z_b)


def test_a_terrain_part_of_another_shape_is_refused(rng: np.random.Generator) -> None:
    client = connect().client
    first, second, *_ = p.encode_terrain(1, "r", rng.normal(size=(300, 400)))
    client.receive(p.pack(first))
    changed = p.Terrain(1, "r", second.part, second.parts, (400, 300), "zstd-f32", second.data)
    with pytest.raises(p.SequenceError):
        client.receive(p.pack(changed))


def test_a_channel_comes_whole_from_its_parts(rng: np.random.Generator) -> None:
    connection = connect()
    command = p.GetChannel(connection.client.next_id(), "r", 3, "velocity")
    connection.ask(command)
    layout = p.BlockLayout(500, 600)
    fields = {name: rng.normal(size=(500, 600)).astype(np.float32) for name in ("u", "v")}
    states = layout.classify(np.ones((500, 600), np.uint16))
    packed = p.encode_channel(layout, "ancestor", 3, 30.0, "velocity", fields, states)
    assert len(packed) > p.limits.PART_BYTES
    connection.tell(p.Ack(command.id))
    parts = list(p.channel_parts(command.id, packed))
    (received,) = [event for part in parts for event in connection.tell(part)]
    assert isinstance(received, p.ChannelReceived)
    assert received.id == command.id
    assert p.pack(received.channel) == packed
    with pytest.raises(p.SequenceError):
        connection.tell(parts[1])


def test_a_picture_comes_whole_from_its_parts(rng: np.random.Generator) -> None:
    connection = connect()
    command = p.GetImagery(connection.client.next_id(), "r")
    connection.ask(command)
    connection.tell(p.Ack(command.id))
    data = rng.bytes(5)
    parts = [p.ImageryPart(command.id, "r", "imagery", part, 2, data[3 * part :][:3]) for part in range(2)]
    assert connection.tell(parts[0]) == []
    assert connection.tell(parts[1]) == [p.ImageryReceived(command.id, "r", "imagery", data)]
    connection.tell(parts[0])
    with pytest.raises(p.SequenceError):
        connection.tell(msgspec.structs.replace(parts[1], layer="walls"))


def test_series_come_whole_from_the_same_parts() -> None:
    connection = connect()
    command = p.GetSeries(connection.client.next_id(), "r")
    connection.ask(command)
    connection.tell(p.Ack(command.id, {"index": 3}))
    series = p.Series("r", 3, bytes(8 * 40000), (), b"", (), b"")
    (received,) = [e for part in p.channel_parts(command.id, p.pack(series)) for e in connection.tell(part)]
    assert received == p.SeriesReceived(command.id, series)


def test_parts_that_hold_no_channel_are_refused() -> None:
    for data in (p.pack(p.Ack(1)), b"\xc1", b""):
        with pytest.raises(p.ProtocolError):
            connect().client.receive(p.pack(p.ChannelPart(1, 0, 1, data)))


def test_the_end_tells_which_commands_will_never_be_answered() -> None:
    client = connect().client
    client.send(p.ListRuns(client.next_id()))
    assert client.close() == {1: "list_runs"}
    assert client.state is p.SessionState.CLOSED
    with pytest.raises(p.SequenceError):
        client.send(p.ListRuns(client.next_id()))
    with pytest.raises(p.SequenceError):
        client.receive(p.pack(p.Notice("info", "Hi.")))
