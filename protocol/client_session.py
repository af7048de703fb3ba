"""The client's side of a connection, without sockets, clock or threads: bytes in, messages out, and back."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from protocol.codec import operation, pack, unpack_channel, unpack_frame, unpack_server
from protocol.depth_codec import FloatArray
from protocol.errors import InvalidMessage, Overloaded, SequenceError, VersionMismatch
from protocol.limits import (
    MAX_CHANNEL_BYTES,
    MAX_FRAME_BYTES,
    MAX_IMAGERY_BYTES,
    MAX_PENDING_COMMANDS,
    MAX_TERRAIN_BYTES,
)
from protocol.messages import (
    Ack,
    CaseList,
    Channel,
    ChannelPart,
    ClientMessage,
    Command,
    Error,
    Frame,
    FramePart,
    Hello,
    ImageryPart,
    Layer,
    ResumePoint,
    RunList,
    Series,
    ServerMessage,
    Terrain,
    Welcome,
)
from protocol.reassembly import PartAssembler
from protocol.terrain_codec import decode_terrain
from protocol.version import SUPPORTED_VERSIONS


class SessionState(IntEnum):
    """Where a connection stands."""

    CONNECTING = 0
    OPEN = 1
    CLOSED = 2


@dataclass(frozen=True)
class TerrainReceived:
    """A base bed, put together from its parts.

    Attributes:
        id: id of the `get_terrain` command.
        run: id of the run.
        z_b: bed [m, relative to the datum offset], float32 [nrows, ncols].
    """

    id: int
    run: str
    z_b: FloatArray


@dataclass(frozen=True)
class ChannelReceived:
    """A channel, put together from its parts; `decode_channel` unpacks it.

    Attributes:
        id: id of the `get_channel` command.
        channel: the packed channel.
    """

    id: int
    channel: Channel


@dataclass(frozen=True)
class SeriesReceived:
    """Series of gauges and sections, put together from their parts; `decode_series` unpacks them.

    Attributes:
        id: id of the `get_series` command.
        series: the packed series.
    """

    id: int
    series: Series


@dataclass(frozen=True)
class ImageryReceived:
    """A picture of the terrain, put together from its parts and not unpacked.

    Attributes:
        id: id of the `get_imagery` command.
        run: id of the run.
        layer: which picture.
        data: the bytes of a JPEG ("imagery") or PNG ("walls") file.
    """

    id: int
    run: str
    layer: Layer
    data: bytes


ClientEvent = ServerMessage | TerrainReceived | ChannelReceived | SeriesReceived | ImageryReceived


class ClientSession:
    """Speaks the protocol for a client.

    Args:
        client: name and version of the client program.
        token: access token, or none when the Authorization header carries it.

    Attributes:
        state: where the connection stands.
        welcome: what the service said first, once the connection is open.
        pending: operation of each command that is not answered yet, by its id.
    """

    def __init__(self, client: str, token: str | None = None) -> None:
        self.state = SessionState.CONNECTING
        self.welcome: Welcome | None = None
        self.pending: dict[int, str] = {}
        self._client = client
        self._token = token
        self._last_id = 0
        self._last_sent_id = 0
        self._hello_sent = False
        self._frame_parts = PartAssembler("frame", MAX_FRAME_BYTES)
        self._terrain_parts = PartAssembler("terrain", MAX_TERRAIN_BYTES)
        self._imagery_parts = PartAssembler("picture", MAX_IMAGERY_BYTES)
        self._channel_parts = PartAssembler("channel", MAX_CHANNEL_BYTES)

    def open(self, resume: ResumePoint | None = None) -> bytes:
        """The `hello` to send first.

        Args:
            resume: what was last known, when this connection replaces a lost one.

        Raises:
            SequenceError: when it was made before.
        """
        if self._hello_sent:
            raise SequenceError("A session says hello once.")
        self._hello_sent = True
        return pack(Hello(client=self._client, token=self._token, resume=resume))

    def next_id(self) -> int:
        """A fresh command id; commands are sent in the order of their ids."""
        self._last_id += 1
        return self._last_id

    def send(self, message: ClientMessage) -> bytes:
        """Bytes of a message.

        Raises:
            SequenceError: before the welcome, after the end, or when a command's id is not above all before.
            Overloaded: when too many commands are unanswered.
        """
        if self.state is not SessionState.OPEN or isinstance(message, Hello):
            raise SequenceError(
                f"{operation(message)!r} cannot be sent while the session is {self.state.name}."
            )
        if isinstance(message, Command):
            if message.id <= self._last_sent_id:
                raise SequenceError(
                    f"Command id {message.id} is not above {self._last_sent_id}, the last one."
                )
            if len(self.pending) >= MAX_PENDING_COMMANDS:
                raise Overloaded(f"{len(self.pending)} commands are unanswered; no more are allowed.")
            self._last_sent_id = message.id
            self._last_id = max(self._last_id, message.id)
            self.pending[message.id] = operation(message)
        return pack(message)

    def receive(self, data: bytes) -> list[ClientEvent]:
        """What one message of the service means: no event for a part, else one.

        Frames come whole as `Frame`, terrain as `TerrainReceived`, channels as `ChannelReceived`,
        pictures of the terrain as `ImageryReceived`.

        Raises:
            ProtocolError: when the service breaks the protocol; close the connection with its close_code.
        """
        if self.state is SessionState.CLOSED:
            raise SequenceError("A message came after the end of the session.")
        message = unpack_server(data)
        if self.state is SessionState.CONNECTING:
            self._begin(message)
        elif isinstance(message, Welcome):
            raise SequenceError("A second 'welcome' came.")
        self._settle(message)
        if isinstance(message, FramePart):
            return self._add_frame_part(message)
        if isinstance(message, Terrain):
            return self._add_terrain_part(message)
        if isinstance(message, ImageryPart):
            identity = (message.id, message.run, message.layer)
            whole = self._imagery_parts.add(identity, message.part, message.parts, message.data)
            return [] if whole is None else [ImageryReceived(message.id, message.run, message.layer, whole)]
        if isinstance(message, ChannelPart):
            return self._add_channel_part(message)
        return [message]

    def close(self) -> dict[int, str]:
        """End the session.

        Returns:
            The commands that will never be answered.
        """
        self.state = SessionState.CLOSED
        unanswered, self.pending = self.pending, {}
        return unanswered

    def _begin(self, message: ServerMessage) -> None:
        if isinstance(message, Welcome) and self._hello_sent:
            if message.protocol not in SUPPORTED_VERSIONS:
                raise VersionMismatch(
                    f"The service chose {message.protocol!r}; {', '.join(SUPPORTED_VERSIONS)} is spoken here."
                )
            self.welcome = message
            self.state = SessionState.OPEN
        elif not (isinstance(message, Error) and message.id is None):
            raise SequenceError(f"{operation(message)!r} came before the welcome.")

    def _settle(self, message: ServerMessage) -> None:
        """Take the command that a message answers off the pending ones."""
        if not isinstance(message, Ack | Error | CaseList | RunList) or message.id is None:
            return
        command = self.pending.pop(message.id, None)
        if command is None:
            raise SequenceError(f"{operation(message)!r} answers command {message.id}, which is not pending.")

    def _add_frame_part(self, part: FramePart) -> list[ClientEvent]:
        whole = self._frame_parts.add((part.run, part.index), part.part, part.parts, part.data)
        if whole is None:
            return []
        frame: Frame = unpack_frame(whole)
        if (frame.run, frame.index) != (part.run, part.index):
            raise InvalidMessage(f"The parts of frame {part.index} hold frame {frame.index}.")
        return [frame]

    def _add_channel_part(self, part: ChannelPart) -> list[ClientEvent]:
        whole = self._channel_parts.add(part.id, part.part, part.parts, part.data)
        if whole is None:
            return []
        packed = unpack_channel(whole)
        if isinstance(packed, Series):
            return [SeriesReceived(part.id, packed)]
        return [ChannelReceived(part.id, packed)]

    def _add_terrain_part(self, part: Terrain) -> list[ClientEvent]:
        identity = (part.id, part.run, part.shape)
        whole = self._terrain_parts.add(identity, part.part, part.parts, part.data)
        if whole is None:
            return []
        return [TerrainReceived(part.id, part.run, decode_terrain(whole, part.shape))]
