"""A small service on a real socket: the wire of a solver service round a flood that is written down as a
formula.

It speaks through `protocol.ServerSession`, so what a viewer sees is the true protocol; only the water is
made up: a tongue that runs east along a valley, 2 cells a frame, and stops at the first raised cell of a
recalculated run.
"""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field

import msgspec
import numpy as np
import numpy.typing as npt
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import Server, ServerConnection, serve
from websockets.typing import Subprotocol

import protocol
from protocol.terrain_codec import encode_terrain

NROWS, NCOLS, DX, INTERVAL, FRAMES = 72, 96, 10.0, 10.0, 40
GRID = protocol.GridGeometry(NROWS, NCOLS, DX, 1000.0, 2000.0, "local", "local", 100.0)
TOKEN = "tiny-token"


EditCommand = (
    protocol.AppendEdit
    | protocol.AppendEdits
    | protocol.ReplaceEdit
    | protocol.DeleteEdit
    | protocol.UndoEdit
    | protocol.RedoEdit
)


def valley() -> npt.NDArray[np.float32]:
    """A valley that falls to the east, with its floor in the middle rows [m]."""
    row, col = np.mgrid[0:NROWS, 0:NCOLS].astype(np.float64)
    return (0.02 * (row - NROWS / 2) ** 2 + 0.3 * (NCOLS - col)).astype(np.float32)


def flood(
    index: int, edits: tuple[protocol.Edit, ...] = (), branch_index: int = 0
) -> npt.NDArray[np.float32]:
    """Depth of frame `index` [m]; behind raised ground the water stops from the branch on."""
    h = np.zeros((NROWS, NCOLS), dtype=np.float32)
    front = 8 + 2 * index
    bed = protocol.apply_edits(valley(), edits, GRID)
    if edits and bed.dirty is not None:
        front = min(front, max(bed.dirty[2], 8 + 2 * branch_index))
    middle = NROWS // 2
    h[middle - 6 : middle + 7, : min(front, NCOLS)] = 2.0
    return np.maximum(h - (bed.z_b - valley()), 0.0).astype(np.float32)


def channel(run: str, index: int, name: protocol.ChannelName) -> bytes:
    """Velocity and maxima of frame `index`: the water runs east, faster by 0.1 m/s each frame."""
    h = flood(index)
    layout = protocol.BlockLayout(NROWS, NCOLS)
    states = layout.classify((h > 0.0).astype(np.uint16))
    if name == "velocity":
        fields = {"u": np.where(h > 0.0, 0.1 * index, 0.0).astype(np.float32), "v": np.zeros_like(h)}
    else:
        came = np.maximum(np.arange(NCOLS) - 7, 0) // 2 * INTERVAL
        fields = {
            "max_depth": h,
            "max_speed": np.where(h > 0.0, 0.1 * index, 0.0).astype(np.float32),
            "max_hazard": np.where(h > 0.0, 2.5, 0.0).astype(np.float32),
            "arrival_time": np.where(h > 0.0, came[None, :], np.inf).astype(np.float32),
        }
    return protocol.encode_channel(layout, run, index, index * INTERVAL, name, fields, states)


ITEMS = (
    protocol.ForcingItem(
        "spring", "source", "m3/s", 0.0, 100.0, protocol.ForcingSeries((0.0, 60.0), (2.0, 5.0))
    ),
    protocol.ForcingItem("sea", "stage", "m", -10.0, 10.0, protocol.ForcingSeries((0.0,), (1.5,))),
    protocol.ForcingItem("rain", "rain", "mm/h", 0.0, 1000.0),
    protocol.ForcingItem("dam", "breach", "s", start_time=120.0),
)


@dataclass
class TinyRun:
    info: protocol.RunInfo
    forcing: tuple[protocol.ForcingChange, ...] = ()
    applied: tuple[protocol.ForcingChange, ...] = ()
    edits: tuple[protocol.Edit, ...] = ()
    log: protocol.EditLog = field(default_factory=protocol.EditLog)
    frames: dict[int, bytes] = field(default_factory=dict)
    keys: dict[int, int] = field(default_factory=dict)


class TinyService:
    """Serves on a free port of this machine until `close`.

    Attributes:
        url: its address.
        computed: number of frames that are computed; tests raise it.
        is_streaming: whether frames are sent; tests hold them back.
        presented: every view that a viewer presented.
        channels: what its runs keep beside the depth.
        channels_asked: index and name of every channel that was asked for.
        hellos: every hello that came, so that tests see what a viewer said when it came back.
    """

    def __init__(self, computed: int = FRAMES, port: int = 0) -> None:
        self.computed = computed
        self.is_streaming = True
        self.hellos: list[protocol.Hello] = []
        self.channels: tuple[protocol.ChannelName, ...] = ("velocity", "maxima")
        self.channels_asked: list[tuple[int, str]] = []
        self.presented: list[protocol.View | None] = []
        self.authorizations: list[str | None] = []
        self.runs: dict[str, TinyRun] = {}
        self.lock = threading.RLock()
        self.connections: list[ServerConnection] = []
        self.server: Server = serve(
            self._converse, "127.0.0.1", port, subprotocols=[Subprotocol("fev.v1")], compression=None
        )
        self.port = self.server.socket.getsockname()[1]
        self.url = f"ws://127.0.0.1:{self.port}/v1/stream"
        self.thread = threading.Thread(target=self.server.serve_forever, daemon=True)
        self.thread.start()

    def close(self) -> None:
        self.server.shutdown()
        self.cut()
        self.thread.join(5.0)

    def cut(self) -> None:
        """Break every connection without a goodbye."""
        for connection in list(self.connections):
            connection.socket.close()

    def add_run(self, parent: TinyRun | None = None, branch_index: int = 0) -> TinyRun:
        with self.lock:
            run = f"run-{len(self.runs) + 1}"
            lineage = () if parent is None else parent.info.lineage
            info = protocol.RunInfo(
                run=run,
                case="tiny",
                title="Tiny valley",
                status="running",
                grid=protocol.GridInfo.from_geometry(GRID),
                duration=(FRAMES - 1) * INTERVAL,
                output_interval=INTERVAL,
                frame_count=self.computed,
                device="cpu",
                hypothetical=True,
                depth_wet=0.001,
                channels=self.channels,
                parent=None if parent is None else parent.info.run,
                branch_index=None if parent is None else branch_index,
                lineage=(*lineage, protocol.LineageEntry(run, branch_index)),
            )
            made = TinyRun(info)
            if parent is not None:
                made.edits = parent.log.edits
                made.log = protocol.EditLog(parent.log.edits, parent.log.revision)
                made.forcing = made.applied = parent.forcing
                made.info = msgspec.structs.replace(info, forcing_revision=parent.info.forcing_revision)
            encoder = protocol.FrameEncoder(GRID)
            for index in range(branch_index, FRAMES):
                water = flood(index, made.edits, branch_index)
                packed = encoder.encode(run, index, index * INTERVAL, made.log.revision, water)
                made.frames[index] = packed
                made.keys[index] = protocol.unpack_frame(packed).key_index
            self.runs[run] = made
            return made

    def holder(self, run: str, index: int) -> TinyRun:
        entries = self.runs[run].info.lineage
        return self.runs[[entry.run for entry in entries if entry.first_index <= index][-1]]

    def _converse(self, connection: ServerConnection) -> None:
        assert connection.request is not None
        self.authorizations.append(connection.request.headers.get("Authorization"))
        if self.authorizations[-1] != f"Bearer {TOKEN}":
            connection.close(1008, "wrong token")
            return
        self.connections.append(connection)
        session = protocol.ServerSession()
        try:
            while True:
                self._stream(connection, session)
                try:
                    data = connection.recv(timeout=0.01)
                except TimeoutError:
                    continue
                assert isinstance(data, bytes)
                for message in session.receive(data):
                    for reply in self._answer(session, message):
                        for packed in session.send(reply):
                            connection.send(packed)
        except (ConnectionClosed, OSError):
            return
        finally:
            self.connections.remove(connection)

    def _stream(self, connection: ServerConnection, session: protocol.ServerSession) -> None:
        subscription = session.subscription
        if subscription is None or not session.can_send_frame or not self.is_streaming:
            return
        index = subscription.from_index
        if index >= self.computed:
            return
        holder = self.holder(subscription.run, index)
        key = session.needed_key(holder.info.run, holder.keys[index])
        for at in [index] if key is None or key == index else [key, index]:
            for packed in session.send_frame(holder.frames[at]):
                connection.send(packed)
        session.subscription = msgspec.structs.replace(subscription, from_index=index + 1)

    def _answer(
        self, session: protocol.ServerSession, message: protocol.ClientMessage
    ) -> list[protocol.ServerMessage]:
        with self.lock:
            match message:
                case protocol.Hello():
                    self.hellos.append(message)
                    return [protocol.Welcome(protocol="fev.v1", server="tiny", version="1", session="s1")]
                case protocol.ListCases():
                    case = protocol.CaseSummary(
                        "tiny", "Tiny valley", True, NROWS, NCOLS, DX, 390.0, INTERVAL
                    )
                    return [protocol.CaseList(message.id, (case,))]
                case protocol.ListRuns():
                    return [
                        protocol.RunList(message.id, tuple(run.info for run in reversed(self.runs.values())))
                    ]
                case protocol.StartRun():
                    if message.case != "tiny":
                        return [
                            protocol.Error(message.id, "unknown_case", f"Case {message.case!r} is unknown.")
                        ]
                    run = self.add_run()
                    run.forcing = run.applied = message.forcing
                    return [protocol.Ack(message.id, {"run": run.info.run}), protocol.RunChanged(run.info)]
                case protocol.GetChannel():
                    return self._channel(message)
                case protocol.GetTerrain():
                    parts = encode_terrain(message.id, message.run, valley())
                    return [protocol.Ack(message.id), *parts]
                case (
                    protocol.AppendEdit()
                    | protocol.AppendEdits()
                    | protocol.ReplaceEdit()
                    | protocol.DeleteEdit()
                    | protocol.UndoEdit()
                    | protocol.RedoEdit()
                ):
                    return self._edit(message)
                case protocol.Recalculate():
                    return self._recalculate(session, message)
                case protocol.ChangeForcing():
                    return self._force(message)
                case protocol.Subscribe() if message.run in self.runs:
                    return [protocol.Ack(message.id), self._forcing(self.runs[message.run])]
                case protocol.TakeControl() | protocol.ReleaseControl():
                    holder = "s1" if isinstance(message, protocol.TakeControl) else message.to
                    return [protocol.Ack(message.id), protocol.ControlChanged(message.run, holder, "tiny")]
                case protocol.RenameRun() | protocol.PinRun() | protocol.UnpinRun() | protocol.DeleteRun():
                    return self._mark(message)
                case protocol.PauseRun() | protocol.ResumeRun() | protocol.StopRun():
                    return self._control(message)
                case protocol.PresentView():
                    self.presented.append(message.view)
                    return [protocol.Ack(message.id)]
                case protocol.Credit():
                    return []
                case _:
                    return [protocol.Ack(message.id)]

    def _edit(self, message: EditCommand) -> list[protocol.ServerMessage]:
        log = self.runs[message.run].log
        try:
            match message:
                case protocol.AppendEdit() | protocol.ReplaceEdit():
                    protocol.check_edit(message.edit, GRID)
                    is_new = isinstance(message, protocol.AppendEdit)
                    log.append(message.edit) if is_new else log.replace(message.edit)
                case protocol.AppendEdits():
                    log.append(*message.edits)
                case protocol.DeleteEdit():
                    log.delete(message.edit)
                case protocol.UndoEdit():
                    log.undo()
                case protocol.RedoEdit():
                    log.redo()
        except protocol.EditError as error:
            return [protocol.Error(message.id, "edit", str(error))]
        changed = protocol.EditsChanged(
            message.run, log.revision, log.edits, log.can_undo, log.can_redo, log.undone
        )
        return [protocol.Ack(message.id, {"revision": log.revision}), changed]

    def _recalculate(
        self, session: protocol.ServerSession, message: protocol.Recalculate
    ) -> list[protocol.ServerMessage]:
        parent = self.runs[message.run]
        if message.index >= self.computed:
            return [protocol.Error(message.id, "not_computed", f"Frame {message.index} is not computed yet.")]
        if message.forcing_revision not in (None, parent.info.forcing_revision):
            return [protocol.Error(message.id, "refused", "The forcing has moved on.")]
        child = self.add_run(parent, message.index)
        parent.info = msgspec.structs.replace(parent.info, status="paused")
        session.move_to(child.info.run, message.index)
        log = child.log
        return [
            protocol.Ack(message.id, {"run": child.info.run}),
            protocol.RunChanged(child.info),
            self._forcing(child),
            protocol.EditsChanged(child.info.run, log.revision, log.edits, log.can_undo, log.can_redo),
            protocol.RunChanged(parent.info),
        ]

    @staticmethod
    def _forcing(run: TinyRun) -> protocol.ForcingChanged:
        return protocol.ForcingChanged(
            run.info.run, run.info.forcing_revision, run.forcing, run.applied, ITEMS
        )

    def _force(self, message: protocol.ChangeForcing) -> list[protocol.ServerMessage]:
        run = self.runs[message.run]
        if any(change.factor == 13.0 for change in message.changes):
            return [protocol.Error(message.id, "invalid_forcing", "Thirteen is refused.")]
        run.forcing = message.changes
        revision = run.info.forcing_revision + 1
        run.info = msgspec.structs.replace(run.info, forcing_revision=revision)
        return [protocol.Ack(message.id, {"revision": revision}), self._forcing(run)]

    def _mark(
        self, message: protocol.RenameRun | protocol.PinRun | protocol.UnpinRun | protocol.DeleteRun
    ) -> list[protocol.ServerMessage]:
        run = self.runs[message.run]
        match message:
            case protocol.DeleteRun():
                return [protocol.Ack(message.id), protocol.RunRemoved(message.run)]
            case protocol.RenameRun():
                run.info = msgspec.structs.replace(run.info, label=message.label)
            case _:
                pinned = isinstance(message, protocol.PinRun)
                run.info = msgspec.structs.replace(run.info, pinned=pinned)
        return [protocol.Ack(message.id), protocol.RunChanged(run.info)]

    def _channel(self, message: protocol.GetChannel) -> list[protocol.ServerMessage]:
        self.channels_asked.append((message.index, message.channel))
        if message.index >= self.computed or message.channel not in self.channels:
            return [
                protocol.Error(message.id, "not_kept", f"Frame {message.index} has no {message.channel}.")
            ]
        holder = self.holder(message.run, message.index).info.run
        packed = channel(holder, message.index, message.channel)
        size = protocol.limits.PART_BYTES
        chunks = [packed[at : at + size] for at in range(0, len(packed), size)]
        parts = [protocol.ChannelPart(message.id, k, len(chunks), data) for k, data in enumerate(chunks)]
        return [protocol.Ack(message.id), *parts]

    def _control(
        self, message: protocol.PauseRun | protocol.ResumeRun | protocol.StopRun
    ) -> list[protocol.ServerMessage]:
        run = self.runs[message.run]
        status = {"PauseRun": "paused", "ResumeRun": "running", "StopRun": "stopped"}[type(message).__name__]
        run.info = msgspec.structs.replace(run.info, status=status)
        return [protocol.Ack(message.id), protocol.RunChanged(run.info)]


def wait_for(condition: object, timeout_s: float = 10.0) -> None:
    """Wait until `condition()` holds."""
    assert callable(condition)
    end = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.005)
