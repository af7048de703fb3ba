"""Cuts of the stream at random bytes, without sockets: does a client end with the same frames and edits?

The bytes are those of real websocket peers (websockets' protocols without I/O) around the two sessions of
`protocol`; behind the service's session stand its own commands, feed, outbox, tree and store. A connection is
cut after a random number of bytes towards the client and another number towards the service: what is not
whole by then is lost. The client connects again with what it knows and sends again what it misses.
"""

from __future__ import annotations

import asyncio
import random
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from websockets.frames import Frame as WebsocketFrame
from websockets.frames import Opcode
from websockets.protocol import CLIENT, SERVER, Protocol

import protocol
from protocol import BlockLayout, EditLine, EditType, FrameDecoder, FrameEncoder, GridInfo, Operation
from solver_service.runs import Session
from solver_service.runs.audience import Audience
from solver_service.runs.case_facts import CaseFacts
from solver_service.runs.controllers import Controllers
from solver_service.runs.edit_desk import EditDesk
from solver_service.runs.forcing_desk import ForcingDesk
from solver_service.runs.run_tree import Run, RunTree
from solver_service.runs.store_thread import StoreThread
from solver_service.store import DataFolder, FrameReader, FrameRecord, FrameWriter, RunDatabase, RunRecord
from solver_service.web.auth import LOCAL
from solver_service.web.commands import carry_out
from solver_service.web.frame_feed import FrameFeed
from solver_service.web.outbox import Outbox
from solver_service.web.quotas import Quotas
from solver_service.web.token_limits import TokenLimits
from solver_service.web.token_store import TokenStore

COUNT = 1000
SMOKE_COUNT = 50
FRAMES = 70
EDITS = 12
SHAPE = (70, 90)
RUN = "r1"
LONGEST_LIFE = 30_000
"""Most bytes before a cut."""


class StoredRuns:
    """What the commands and the feed of a connection need of a service: one run with frames, no worker."""

    def __init__(self, root: Path) -> None:
        folder = DataFolder(root)
        self.reader = FrameReader(folder)
        self.store = StoreThread(folder)
        self.tree = RunTree()
        self.audience = Audience()
        self.edits = EditDesk(self.tree, self.store, self.audience)
        self.forcing = ForcingDesk(self.tree, self.store, self.audience)
        self.controllers = Controllers(self.audience.announce)
        self.quotas = Quotas(TokenLimits(), TokenStore(root), self)  # type: ignore[arg-type]
        self._fill(folder)

    async def read_frame(self, record: FrameRecord) -> bytes:
        """The packed bytes of a frame."""
        return self.reader.read(record)

    def _fill(self, folder: DataFolder) -> None:
        database = RunDatabase(folder.database)
        database.begin_epoch()
        facts = CaseFacts(GridInfo(*SHAPE, 10.0, 0.0, 0.0), True, 1e-3)
        record = RunRecord(
            RUN, "case", "f00d", "", None, 0, "finished", "", 1e3, 5.0, "cpu", 0, b"\x90", facts.pack()
        )
        database.insert_run(record)
        encoder, rng = FrameEncoder(BlockLayout(*SHAPE)), np.random.default_rng(1)
        writer, run = FrameWriter(folder, database, RUN), Run.of(record, ())
        h = np.zeros(SHAPE)
        for index in range(FRAMES):
            h[rng.integers(0, SHAPE[0], 200), rng.integers(0, SHAPE[1], 200)] = rng.random(200)
            frame = encoder.encode(RUN, index, 5.0 * index, 0, h)
            key = protocol.peek_frame(frame).key_index
            run.frames.append(
                writer.append(index=index, time=5.0 * index, revision=0, key_index=key, frame=frame)
            )
        writer.close()
        epoch = database.epoch
        database.close()
        self.store._database.epoch = epoch
        self.tree.add(run)


class _ServiceSide:
    """A connection as `web.stream` has it, driven by hand."""

    def __init__(self, runs: StoredRuns, name: str) -> None:
        self.registry = runs
        self.quotas = runs.quotas
        self.session = protocol.ServerSession()
        self.feed = FrameFeed(runs, self.session)  # type: ignore[arg-type]
        self.outbox = Outbox()
        self.identity = Session(name)
        runs.audience.add(self)

    def find_session(self, name: str) -> Session | None:
        """Nobody else is there."""
        return None

    def announce(self, message: protocol.ServerMessage) -> None:
        """Queue news of the run."""
        if isinstance(message, protocol.EditsChanged) and self.feed.run == message.run:
            self.tell(message)

    def frame_stored(self, run: str) -> None:
        """No frame is new here."""

    def tell(self, message: protocol.ServerMessage) -> None:
        """Queue one message."""
        self.outbox.put(self.session.send(message))

    async def take(self, data: bytes) -> None:
        """Do what a message asks."""
        (message,) = self.session.receive(data)
        if isinstance(message, protocol.Hello):
            self.tell(protocol.Welcome(protocol.PROTOCOL_VERSION, "cuts", "1", self.identity.session))
            if message.resume is not None and message.resume.session is not None:
                self.registry.controllers.replaced(message.resume.session, self.identity)
        elif isinstance(message, protocol.Command):
            try:
                await carry_out(message, self, LOCAL)  # type: ignore[arg-type]
            except protocol.ProtocolError as error:
                self.tell(protocol.Error(message.id, error.code, str(error)))

    async def packets(self) -> list[bytes]:
        """All that can be sent now."""
        sent = []
        while True:
            packet = self.outbox.next()
            if packet is not None:
                sent.append(packet)
                continue
            frame = await self.feed.next()
            if frame is None:
                return sent
            self.outbox.put_bulk(self.session.send_frame(frame))

    def end(self) -> None:
        """The connection is over."""
        self.registry.audience.remove(self)
        self.registry.controllers.ended(self.identity.session)
        self.session.close()


@dataclass
class Viewer:
    """What a client keeps over its connections."""

    decoder: FrameDecoder = field(default_factory=lambda: FrameDecoder(BlockLayout(*SHAPE)))
    water: dict[int, bytes] = field(default_factory=dict)
    edits: tuple[str, ...] = ()
    revision: int = 0
    session: str | None = None
    acknowledged: list[str] = field(default_factory=list)

    @property
    def next_index(self) -> int:
        """The first frame it lacks."""
        return next(index for index in range(FRAMES + 1) if index not in self.water)

    @property
    def next_edit(self) -> str | None:
        """The first edit that the service does not have."""
        return next((f"e{k}" for k in range(EDITS) if f"e{k}" not in self.edits), None)

    @property
    def is_done(self) -> bool:
        """Whether it has everything."""
        return self.next_index == FRAMES and self.next_edit is None


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Whether viewers end with the frames and edits of the store, over so many cuts."""
    count = SMOKE_COUNT if smoke else COUNT
    with tempfile.TemporaryDirectory(prefix="fev-cuts-") as folder:
        cuts, viewers, wrong = asyncio.run(cut_again_and_again(Path(folder), count))
    yield {"figure": "cuts", "value": cuts, "unit": "cuts"}
    yield {"figure": "viewers", "value": viewers, "unit": "1"}
    yield {"figure": "viewers_with_another_final_state", "value": wrong, "unit": "1"}


async def cut_again_and_again(folder: Path, count: int, seed: int = 1) -> tuple[int, int, int]:
    """Cut so many connections.

    Returns:
        Cuts, viewers that came to their end, and those whose final state is not that of the store.
    """
    chance = random.Random(seed)
    cuts = viewers = wrong = 0
    while cuts < count:
        runs = StoredRuns(folder / f"store{viewers}")
        truth = await _water_of(runs)
        viewer = Viewer()
        connection = 0
        while not viewer.is_done:
            connection += 1
            limits = chance.randrange(1, LONGEST_LIFE), chance.randrange(1, LONGEST_LIFE // 4)
            await _connect(runs, viewer, f"s{viewers}-{connection}", *limits)
            cuts += not viewer.is_done
        viewers += 1
        stored = tuple(edit.id for edit in runs.tree.get(RUN).edit_log.edits)
        expected = tuple(f"e{k}" for k in range(EDITS))
        lost = [name for name in viewer.acknowledged if name not in stored]
        wrong += viewer.water != truth or stored != expected or viewer.edits != expected or bool(lost)
        runs.store.close()
    return cuts, viewers, wrong


async def _water_of(runs: StoredRuns) -> dict[int, bytes]:
    decoder = FrameDecoder(BlockLayout(*SHAPE))
    frames = [protocol.peek_frame(await runs.read_frame(row)) for row in runs.tree.get(RUN).frames]
    return {frame.index: decoder.decode(frame).q.tobytes() for frame in frames}


async def _connect(runs: StoredRuns, viewer: Viewer, name: str, to_client: int, to_service: int) -> None:
    """One connection until it is cut, or the viewer has everything."""
    service = _ServiceSide(runs, name)
    client = protocol.ClientSession("cuts")
    down = _Pipe(Protocol(SERVER), Protocol(CLIENT), to_client)
    up = _Pipe(Protocol(CLIENT), Protocol(SERVER), to_service)
    resume = None
    if viewer.session is not None:
        resume = protocol.ResumePoint(RUN, viewer.next_index - 1, viewer.revision, viewer.session)
    outgoing = [client.open(resume)]
    asked: dict[int, str] = {}
    while not viewer.is_done and not (down.is_cut or up.is_cut):
        for data in outgoing:
            for whole in up.carry(data):
                await service.take(whole)
        outgoing = []
        for packet in await service.packets():
            for whole in down.carry(packet):
                for event in client.receive(whole):
                    outgoing += _answer(viewer, client, event, asked)
    service.end()


def _answer(
    viewer: Viewer, client: protocol.ClientSession, event: protocol.ClientEvent, asked: dict[int, str]
) -> list[bytes]:
    """Take an event in; gives what to send then."""
    match event:
        case protocol.Welcome():
            viewer.session = event.session
            subscribe = protocol.Subscribe(client.next_id(), RUN, viewer.next_index, "replay", 2)
            return [client.send(subscribe)]
        case protocol.EditsChanged():
            viewer.edits, viewer.revision = tuple(edit.id for edit in event.edits), event.revision
            return _next_edit(viewer, client, asked)
        case protocol.Frame():
            viewer.water[event.index] = viewer.decoder.decode(event).q.tobytes()
            return [client.send(protocol.Credit(1))]
        case protocol.Ack() if event.id in asked:
            viewer.acknowledged.append(asked[event.id])
    return []


def _next_edit(viewer: Viewer, client: protocol.ClientSession, asked: dict[int, str]) -> list[bytes]:
    name = viewer.next_edit
    if name is None or name in asked.values():
        return []
    edit = EditLine(
        id=name,
        vertices=((50.0, 50.0), (500.0, 400.0)),
        width=20.0,
        operation=Operation.raise_,
        type=EditType.modulate,
        magnitude=1.0,
    )
    command = protocol.AppendEdit(client.next_id(), RUN, edit)
    asked[command.id] = name
    return [client.send(command)]


class _Pipe:
    """One direction of a websocket that is cut after so many bytes."""

    def __init__(self, sender: Protocol, receiver: Protocol, limit: int) -> None:
        self._sender = sender
        self._receiver = receiver
        self._left = limit

    @property
    def is_cut(self) -> bool:
        """Whether nothing passes any more."""
        return self._left <= 0

    def carry(self, data: bytes) -> list[bytes]:
        """Send a message; gives those that arrive whole."""
        self._sender.send_binary(data)
        raw = b"".join(self._sender.data_to_send())[: max(self._left, 0)]
        self._left -= max(len(raw), 1)
        self._receiver.receive_data(raw)
        arrived = []
        for event in self._receiver.events_received():
            assert isinstance(event, WebsocketFrame)
            assert event.opcode is Opcode.BINARY
            arrived.append(bytes(event.data))
        return arrived
