"""Tokens against a real service process: every route, kinds of command, the end of a revoked one."""

import time
from contextlib import closing

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

import protocol
from bench.service_process import ServiceProcess
from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore

PUBLIC = {("get", "/healthz"), ("get", "/readyz")}
ROUTES = {
    ("get", "/version"): Scope.VIEWER,
    ("get", "/metrics"): Scope.VIEWER,
    ("get", "/v1/status"): Scope.VIEWER,
    ("get", "/v1/connections"): Scope.OPERATOR,
    ("get", "/v1/cases"): Scope.VIEWER,
    ("get", "/v1/runs"): Scope.VIEWER,
    ("get", "/v1/runs/{run}"): Scope.VIEWER,
    ("post", "/v1/runs"): Scope.CONTROLLER,
    ("delete", "/v1/runs/{run}"): Scope.OPERATOR,
    ("post", "/v1/runs/{run}/{action}"): Scope.OPERATOR,
    ("delete", "/v1/connections/{session}"): Scope.OPERATOR,
    ("delete", "/v1/cases/{case}"): Scope.OPERATOR,
    ("get", "/v1/uploads"): Scope.VIEWER,
    ("get", "/v1/uploads/{upload}"): Scope.VIEWER,
    ("post", "/v1/uploads"): Scope.CONTROLLER,
    ("get", "/v1/events"): Scope.OPERATOR,
    ("get", "/v1/tokens"): Scope.ADMIN,
    ("delete", "/v1/tokens/{token}"): Scope.ADMIN,
}


NAMES = {"run": "r1", "token": "none", "action": "pause", "session": "s1", "case": "none", "upload": "u1"}


def token_of(service: ServiceProcess, scope: Scope, lifetime_s: float | None = None) -> tuple[str, str]:
    """A new token of a scope, and its id."""
    store = TokenStore(service.data_dir)
    token, record = store.create(f"test {scope}", scope, lifetime_s)
    store.close()
    return token, record.id


def revoke(service: ServiceProcess, name: str) -> None:
    store = TokenStore(service.data_dir)
    store.revoke(name)
    store.close()


class Greeted:
    """A connection whose hello may name the connection that it replaces."""

    def __init__(self, service: ServiceProcess, token: str, replaces: str | None = None) -> None:
        self.socket: ClientConnection = connect(
            service.url,
            additional_headers={"Authorization": f"Bearer {token}"},
            subprotocols=[protocol.PROTOCOL_VERSION],  # type: ignore[list-item]
            compression=None,
        ).__enter__()
        resume = None if replaces is None else protocol.ResumePoint("none", 0, 0, replaces)
        self.socket.send(protocol.pack(protocol.Hello(resume=resume)))
        welcome = protocol.unpack_server(bytes(self.socket.recv(timeout=5.0)))  # type: ignore[arg-type]
        assert isinstance(welcome, protocol.Welcome)
        self.session = welcome.session


class Stream:
    """A connection that has been welcomed."""

    def __init__(self, service: ServiceProcess, token: str) -> None:
        self.session = protocol.ClientSession("test")
        self.socket: ClientConnection = connect(
            service.url,
            additional_headers={"Authorization": f"Bearer {token}"},
            subprotocols=[protocol.PROTOCOL_VERSION],  # type: ignore[list-item]
            compression=None,
        ).__enter__()
        self.socket.send(self.session.open())
        assert isinstance(self.next(), protocol.Welcome)

    def next(self) -> object:
        data = self.socket.recv(timeout=15.0)
        assert isinstance(data, bytes)
        return self.session.receive(data)[0]

    def ask(self, kind: type[protocol.Command], **fields: object) -> object:
        command = kind(id=self.session.next_id(), **fields)  # type: ignore[arg-type]
        self.socket.send(self.session.send(command))  # type: ignore[arg-type]
        while getattr(answer := self.next(), "id", None) != command.id:
            pass
        return answer


def test_every_route_of_rest_asks_for_its_scope(service: ServiceProcess) -> None:
    with httpx.Client(base_url=service.http, timeout=30.0) as client:
        paths = client.get("/openapi.json").json()["paths"]
        found = {(method, path) for path, methods in paths.items() for method in methods}
        assert found == PUBLIC | set(ROUTES)
        for method, path in ROUTES:
            assert client.request(method, path).status_code == 401, path
        for scope in Scope:
            headers = {"Authorization": f"Bearer {token_of(service, scope)[0]}"}
            for (method, path), needed in ROUTES.items():
                with client.stream(method, path.format(**NAMES), headers=headers) as answer:
                    endless = answer.headers.get("content-type", "").startswith("text/event-stream")
                    text = "" if endless else answer.read().decode()
                if scope >= needed:
                    assert answer.status_code not in (401, 500), (scope, path)
                    assert "needs the scope" not in text, (scope, path)
                else:
                    assert answer.status_code == 403, (scope, path)
                    assert f"needs the scope {needed}" in text, (scope, path)


def test_a_viewer_may_look_and_is_told_what_it_lacks(service: ServiceProcess) -> None:
    viewer = Stream(service, token_of(service, Scope.VIEWER)[0])
    controller = Stream(service, token_of(service, Scope.CONTROLLER)[0])
    with closing(viewer.socket), closing(controller.socket):
        refusal = viewer.ask(protocol.StartRun, case="dam-break", paused=True)
        assert isinstance(refusal, protocol.Error)
        assert refusal.code == "forbidden"
        assert "start_run needs the scope controller" in refusal.message
        assert isinstance(viewer.ask(protocol.ListRuns), protocol.RunList)

        started = controller.ask(protocol.StartRun, case="dam-break", paused=True)
        assert isinstance(started, protocol.Ack)
        run = started.result["run"]
        refusal = controller.ask(protocol.DeleteRun, run=run)
        assert isinstance(refusal, protocol.Error)
        assert refusal.code == "forbidden"
        assert isinstance(controller.ask(protocol.StopRun, run=run), protocol.Ack)

        operator = Stream(service, service.token)  # the token of the file
        with closing(operator.socket):
            controller.socket.close()
            assert isinstance(operator.ask(protocol.TakeControl, run=run, force=True), protocol.Ack)
            assert isinstance(operator.ask(protocol.DeleteRun, run=run), protocol.Ack)


@pytest.mark.parametrize("how", ["revoked", "expired"])
def test_a_token_that_ends_takes_its_connections_with_it_and_no_other(
    service: ServiceProcess, how: str
) -> None:
    token, name = token_of(service, Scope.VIEWER, 2.0 if how == "expired" else None)
    kept = Stream(service, token_of(service, Scope.VIEWER)[0])
    ended = Stream(service, token)
    with closing(kept.socket), closing(ended.socket):
        assert isinstance(ended.ask(protocol.ListRuns), protocol.RunList)
        begun = time.monotonic()
        if how == "revoked":
            revoke(service, name)
        refusal = ended.next()
        assert isinstance(refusal, protocol.Error)
        assert refusal.code == "wrong_token"
        with pytest.raises(ConnectionClosed) as close:
            ended.next()
        assert close.value.rcvd is not None
        assert close.value.rcvd.code == 1008
        assert "revoked or has expired" in close.value.rcvd.reason
        assert time.monotonic() - begun < 5.0
        assert isinstance(kept.ask(protocol.ListRuns), protocol.RunList)
        with pytest.raises(InvalidStatus) as status:
            Stream(service, token)
        assert status.value.response.status_code == 401


def test_nobody_takes_the_place_of_a_connection_with_another_token(service: ServiceProcess) -> None:
    owner = Greeted(service, service.token)
    thief = Greeted(service, token_of(service, Scope.VIEWER)[0], replaces=owner.session)
    with closing(owner.socket), closing(thief.socket):
        owner.socket.send(protocol.pack(protocol.ListRuns(1)))
        assert isinstance(protocol.unpack_server(bytes(owner.socket.recv(timeout=5.0))), protocol.RunList)  # type: ignore[arg-type]
        second = Greeted(service, service.token, replaces=owner.session)
        with closing(second.socket), pytest.raises(ConnectionClosed) as close:
            owner.socket.recv(timeout=5.0)
        assert close.value.rcvd is not None
        assert close.value.rcvd.code == 4001


def test_an_admin_lists_and_revokes_without_seeing_a_secret(service: ServiceProcess) -> None:
    admin, _ = token_of(service, Scope.ADMIN)
    guest, name = token_of(service, Scope.VIEWER)
    headers = {"Authorization": f"Bearer {admin}"}
    with httpx.Client(base_url=service.http, headers=headers) as client:
        listed = client.get("/v1/tokens")
        assert name in [token["id"] for token in listed.json()]
        assert guest not in listed.text
        assert client.delete(f"/v1/tokens/{name}").json()["revoked"] is not None
        assert client.delete("/v1/tokens/deadbeef").status_code == 404
        assert client.get("/version", headers={"Authorization": f"Bearer {guest}"}).status_code == 401


def test_a_stranger_who_can_read_the_store_has_no_token(service: ServiceProcess) -> None:
    _, name = token_of(service, Scope.ADMIN)
    store = service.data_dir / "tokens.sqlite"
    assert store.stat().st_mode & 0o077 == 0
    with httpx.Client(base_url=service.http) as client:
        for guess in (name, f"fev-{name}", f"fev-{name}-"):
            assert client.get("/version", headers={"Authorization": f"Bearer {guess}"}).status_code == 401
