"""The service's side of a connection, without sockets, clock or threads: bytes in, messages out, and back."""

from __future__ import annotations

from msgspec import structs

from protocol.client_session import SessionState
from protocol.codec import operation, pack, unpack_client, unpack_frame
from protocol.errors import Overloaded, ProtocolError, SequenceError, TooLarge
from protocol.limits import (
    KEY_FRAMES_KEPT,
    MAX_CREDIT,
    MAX_PENDING_COMMANDS,
    OUTBOUND_MAX_BYTES,
    PART_BYTES,
)
from protocol.messages import (
    Ack,
    CaseList,
    ClientMessage,
    Command,
    Error,
    Frame,
    FramePart,
    Hello,
    Message,
    RunList,
    Seek,
    ServerMessage,
    Subscribe,
    SubscriptionMode,
    Unsubscribe,
    Welcome,
)
from protocol.version import negotiate


class ServerSession:
    """Speaks the protocol for a service, one object a connection.

    Frames are paid for: each one sent takes one credit. A key frame that goes ahead of its delta is a frame
    like any other and may overdraw the credit by one, so `can_send_frame` is all a sender has to ask.

    Args:
        max_pending: most commands that may be unanswered.
        part_bytes: size above which a frame is cut in parts.

    Attributes:
        state: where the connection stands.
        hello: the client's first message, once it came.
        version: protocol version in force, once the hello came.
        subscription: what the client wants to see, after `subscribe`, `seek`, `unsubscribe` and `move_to`.
        credit: frames that may still be sent.
    """

    def __init__(self, max_pending: int = MAX_PENDING_COMMANDS, part_bytes: int = PART_BYTES) -> None:
        self.state = SessionState.CONNECTING
        self.hello: Hello | None = None
        self.version: str | None = None
        self.subscription: Subscribe | None = None
        self.credit = 0
        self._max_pending = max_pending
        self._part_bytes = part_bytes
        self._pending: dict[int, Command | None] = {}
        self._last_id = 0
        self._keys_sent: list[tuple[str, int]] = []

    @property
    def pending(self) -> frozenset[int]:
        """Ids of the commands that are not answered yet."""
        return frozenset(self._pending)

    @property
    def keys_sent(self) -> tuple[tuple[str, int], ...]:
        """Run and index of the key frames the client keeps, oldest first."""
        return tuple(self._keys_sent)

    @property
    def can_send_frame(self) -> bool:
        """Whether the client is subscribed and has credit."""
        return self.subscription is not None and self.credit > 0

    def receive(self, data: bytes) -> list[ClientMessage]:
        """What one message of the client means.

        Credit counts at once; a command takes effect when its `ack` is sent.

        Raises:
            ProtocolError: when the client breaks the protocol. Send what `refuse` makes of it, and close
                with its close_code if it is fatal.
        """
        if self.state is SessionState.CLOSED:
            raise SequenceError("A message came after the end of the session.")
        message = unpack_client(data)
        if self.hello is None:
            self._greet(message)
            return [message]
        if isinstance(message, Hello) or self.state is SessionState.CONNECTING:
            raise SequenceError(
                f"{operation(message)!r} came between hello and welcome, or hello came twice."
            )
        if isinstance(message, Command):
            self._register(message)
        elif self.subscription is not None:
            self.credit = min(self.credit + message.frames, MAX_CREDIT)
        return [message]

    def send(self, message: ServerMessage) -> list[bytes]:
        """Bytes of a message, in the order to send them.

        Raises:
            SequenceError: when an answer is sent to a command that is not pending, or before the welcome.
            TooLarge: when the message is larger than a client accepts.
        """
        if isinstance(message, Frame):
            return self.send_frame(pack(message), message)
        if self.state is SessionState.CLOSED:
            raise SequenceError(f"{operation(message)!r} cannot be sent after the end of the session.")
        if isinstance(message, Welcome):
            if self.hello is None or self.state is SessionState.OPEN:
                raise SequenceError("'welcome' answers one hello.")
            self.state = SessionState.OPEN
        elif self.state is SessionState.CONNECTING and not isinstance(message, Error):
            raise SequenceError(f"{operation(message)!r} cannot be sent before the welcome.")
        packed = pack(message)
        if len(packed) > OUTBOUND_MAX_BYTES:
            raise TooLarge(
                f"{operation(message)!r} has {len(packed)} bytes; {OUTBOUND_MAX_BYTES} are allowed."
            )
        self._settle(message)
        return [packed]

    def refuse(self, error: ProtocolError) -> list[bytes]:
        """Bytes of the `error` that tells the client what it did wrong, for what `receive` raised."""
        message_id = error.message_id
        if message_id is not None and message_id > self._last_id and self.state is SessionState.OPEN:
            # The command was refused before it was known here; this is its one answer.
            self._last_id = message_id
            self._pending[message_id] = None
        else:
            # An id that was used before has its own answer, given or to come.
            message_id = None
        return self.send(Error(message_id, error.code, str(error)[:2000]))

    def needed_key(self, run: str, key_index: int) -> int | None:
        """Index of the key frame to send before a frame with this key_index, or none if the client has it."""
        return None if (run, key_index) in self._keys_sent else key_index

    def send_frame(self, data: bytes, frame: Frame | None = None) -> list[bytes]:
        """Bytes that carry a packed frame: itself, or its parts.

        Args:
            data: the packed `frame` message, as it is stored.
            frame: the same frame unpacked, if it is at hand.

        Raises:
            SequenceError: when the session is not open, or the client lacks the key frame of a delta.
        """
        if self.state is not SessionState.OPEN:
            raise SequenceError("A frame cannot be sent while the session is not open.")
        frame = unpack_frame(data) if frame is None else frame
        if frame.is_key:
            self._remember_key((frame.run, frame.index))
        elif self.needed_key(frame.run, frame.key_index) is not None:
            raise SequenceError(
                f"Frame {frame.index} needs the key frame {frame.key_index} to be sent first."
            )
        self.credit -= 1
        if len(data) <= self._part_bytes:
            return [data]
        pieces = [data[at : at + self._part_bytes] for at in range(0, len(data), self._part_bytes)]
        return [
            pack(FramePart(run=frame.run, index=frame.index, part=part, parts=len(pieces), data=piece))
            for part, piece in enumerate(pieces)
        ]

    def move_to(self, run: str, index: int) -> None:
        """Let the subscription go on with another run, as after `recalculate`; mode and credit stay."""
        self._continue(run, index)

    def close(self) -> None:
        """End the session."""
        self.state = SessionState.CLOSED
        self.subscription = None
        self.credit = 0
        self._pending.clear()

    def _greet(self, message: Message) -> None:
        if not isinstance(message, Hello):
            raise SequenceError(f"The first message is {operation(message)!r}; only 'hello' is allowed.")
        self.version = negotiate(message.versions)
        self.hello = message

    def _register(self, command: Command) -> None:
        if command.id <= self._last_id:
            raise SequenceError(f"Command id {command.id} is not above {self._last_id}, the last one.")
        if len(self._pending) >= self._max_pending:
            raise Overloaded(
                f"{len(self._pending)} commands are unanswered; up to {self._max_pending} are allowed."
            )
        self._last_id = command.id
        self._pending[command.id] = command

    def _take_effect(self, command: Command) -> None:
        """Take note of what the client is now to see."""
        if isinstance(command, Subscribe):
            self.subscription = command
            self.credit = command.credit
        elif isinstance(command, Unsubscribe):
            self.subscription = None
            self.credit = 0
        elif isinstance(command, Seek) and self.subscription is not None:
            self._continue(command.run, command.index, "replay")

    def _continue(self, run: str, index: int, mode: SubscriptionMode | None = None) -> None:
        if self.subscription is not None:
            mode = self.subscription.mode if mode is None else mode
            self.subscription = structs.replace(self.subscription, run=run, from_index=index, mode=mode)

    def _settle(self, message: Message) -> None:
        if not isinstance(message, Ack | Error | CaseList | RunList) or message.id is None:
            return
        if message.id not in self._pending:
            raise SequenceError(f"{operation(message)!r} answers command {message.id}, which is not pending.")
        command = self._pending.pop(message.id)
        if isinstance(message, Ack) and command is not None:
            self._take_effect(command)

    def _remember_key(self, name: tuple[str, int]) -> None:
        if name in self._keys_sent:
            self._keys_sent.remove(name)
        self._keys_sent.append(name)
        del self._keys_sent[:-KEY_FRAMES_KEPT]
