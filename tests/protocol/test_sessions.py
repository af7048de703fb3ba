"""A client and a service in any order of what they may do: one answer each, and every frame decodes."""

from collections import deque

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

import protocol as p
from protocol import limits
from tests.protocol.connection import welcome

LAYOUT = p.BlockLayout(34, 40)
FRAME_COUNT = 24


def stored_frames() -> list[bytes]:
    encoder = p.FrameEncoder(LAYOUT, group=3)
    col = np.arange(LAYOUT.ncols, dtype=np.float32)
    return [
        encoder.encode("r", k, 10.0 * k, 0, np.tile(np.maximum(1.0 + k - 0.3 * col, 0.0), (LAYOUT.nrows, 1)))
        for k in range(FRAME_COUNT)
    ]


STORE = stored_frames()
COMMANDS = st.sampled_from([p.ListRuns, p.ListCases, p.Unsubscribe])


class Conversation(RuleBasedStateMachine):
    """Messages wait in two queues, as in a network; frames are decoded as they come."""

    @initialize()
    def connect(self) -> None:
        self.client = p.ClientSession("test")
        self.server = p.ServerSession(part_bytes=48)
        self.to_server: deque[bytes] = deque()
        self.to_client: deque[bytes] = deque()
        self.decoder = p.FrameDecoder(LAYOUT)
        self.answered: set[int] = set()
        self.received = 0
        self.sent = 0
        self.server.receive(self.client.open())
        for data in self.server.send(welcome()):
            self.client.receive(data)

    def ask(self, message: p.ClientMessage) -> None:
        self.to_server.append(self.client.send(message))

    @precondition(lambda self: len(self.client.pending) < limits.MAX_PENDING_COMMANDS)
    @rule(kind=COMMANDS)
    def command(self, kind: type) -> None:
        self.ask(kind(self.client.next_id()))

    @precondition(lambda self: len(self.client.pending) < limits.MAX_PENDING_COMMANDS)
    @rule(index=st.integers(0, FRAME_COUNT - 1), credit=st.integers(1, 4))
    def subscribe(self, index: int, credit: int) -> None:
        self.ask(p.Subscribe(self.client.next_id(), "r", index, "replay", credit))

    @precondition(lambda self: len(self.client.pending) < limits.MAX_PENDING_COMMANDS)
    @rule(index=st.integers(0, FRAME_COUNT - 1))
    def seek(self, index: int) -> None:
        self.ask(p.Seek(self.client.next_id(), "r", index))

    @rule(frames=st.integers(1, 3))
    def grant(self, frames: int) -> None:
        self.ask(p.Credit(frames))

    @precondition(lambda self: self.to_server)
    @rule()
    def server_receives(self) -> None:
        self.server.receive(self.to_server.popleft())

    @precondition(lambda self: self.server.pending)
    @rule(choice=st.integers(0, 10**6), granted=st.booleans())
    def server_answers(self, choice: int, granted: bool) -> None:
        pending = sorted(self.server.pending)
        command_id = pending[choice % len(pending)]
        answer = p.Ack(command_id) if granted else p.Error(command_id, "busy", "Not now.")
        self.to_client.extend(self.server.send(answer))

    @precondition(lambda self: self.server.can_send_frame)
    @rule(index=st.integers(0, FRAME_COUNT - 1))
    def server_sends_frame(self, index: int) -> None:
        credit = self.server.credit
        key = self.server.needed_key("r", p.peek_frame(STORE[index]).key_index)
        wanted = [index] if key is None or key == index else [key, index]
        for each in wanted:
            self.to_client.extend(self.server.send_frame(STORE[each]))
        self.sent += len(wanted)
        assert self.server.credit == credit - len(wanted)

    @precondition(lambda self: self.to_client)
    @rule()
    def client_receives(self) -> None:
        for event in self.client.receive(self.to_client.popleft()):
            if isinstance(event, p.Frame):
                decoded = self.decoder.decode(event)
                expected = p.unpack_frame(STORE[event.index])
                assert event == expected
                np.testing.assert_array_equal(decoded.states, LAYOUT.classify(decoded.q))
                self.received += 1
            elif isinstance(event, p.Ack | p.Error):
                assert event.id not in self.answered
                self.answered.add(event.id)

    @invariant()
    def credit_stays_within_its_bounds(self) -> None:
        assert -1 <= self.server.credit <= limits.MAX_CREDIT

    @invariant()
    def the_service_owes_no_answer_that_the_client_does_not_expect(self) -> None:
        assert self.server.pending <= set(self.client.pending)

    def teardown(self) -> None:
        while self.to_server:
            self.server_receives()
        for command_id in sorted(self.server.pending):
            self.to_client.extend(self.server.send(p.Ack(command_id)))
        while self.to_client:
            self.client_receives()
        assert not self.client.pending
        assert self.received == self.sent


TestConversation = Conversation.TestCase
TestConversation.settings = settings(max_examples=60, stateful_step_count=60, deadline=None)
