"""Two sessions joined by nothing but calls, for the tests of both sides."""

from dataclasses import dataclass, field

import protocol as p


@dataclass
class Connection:
    """A client and a service whose messages arrive at once."""

    client: p.ClientSession = field(default_factory=lambda: p.ClientSession("test"))
    server: p.ServerSession = field(default_factory=p.ServerSession)

    def ask(self, message: p.ClientMessage) -> p.ClientMessage:
        (received,) = self.server.receive(self.client.send(message))
        return received

    def tell(self, message: p.ServerMessage) -> list[p.ClientEvent]:
        return self.deliver(self.server.send(message))

    def deliver(self, pieces: list[bytes]) -> list[p.ClientEvent]:
        return [event for piece in pieces for event in self.client.receive(piece)]

    def subscribe(self, credit: int = 2, mode: p.SubscriptionMode = "replay") -> None:
        command = p.Subscribe(self.client.next_id(), "r", 0, mode, credit)
        self.ask(command)
        self.tell(p.Ack(command.id))


def welcome() -> p.Welcome:
    return p.Welcome(protocol="fev.v1", server="test", version="0", session="s")


def connect() -> Connection:
    connection = Connection()
    connection.server.receive(connection.client.open())
    connection.tell(welcome())
    return connection
