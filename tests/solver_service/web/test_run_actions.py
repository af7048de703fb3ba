"""What an operator may do to any run and connection."""

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

import protocol
from bench.service_process import ServiceClient, ServiceProcess


@pytest.fixture
def rest(service: ServiceProcess) -> httpx.Client:
    headers = {"Authorization": f"Bearer {service.token}"}
    with httpx.Client(base_url=service.http, headers=headers, timeout=60.0) as client:
        yield client


def status(rest: httpx.Client, run: str) -> str:
    return str(rest.get(f"/v1/runs/{run}").json()["status"])


def test_an_operator_steers_a_run_that_somebody_else_controls(
    service: ServiceProcess, rest: httpx.Client
) -> None:
    with ServiceClient(service) as owner:
        run = owner.do(protocol.StartRun, case="dam-break", duration=1e6)["run"]
        owner.do(protocol.Subscribe, run=run)
        owner.frame(run, 1)
        assert rest.post(f"/v1/runs/{run}/pause").status_code == 204
        assert status(rest, run) == "paused"
        owner.first(protocol.RunChanged, lambda event: event.run.status == "paused")
        for action in ("resume", "pin", "stop"):
            assert rest.post(f"/v1/runs/{run}/{action}").status_code == 204
        owner.first(protocol.RunChanged, lambda event: event.run.status == "stopped")
        refused = rest.delete(f"/v1/runs/{run}")
        assert refused.status_code == 409
        assert "is pinned" in refused.json()["detail"]
        assert rest.post(f"/v1/runs/{run}/unpin").status_code == 204
        assert rest.delete(f"/v1/runs/{run}").status_code == 204
        owner.first(protocol.RunRemoved, lambda event: event.run == run)
    assert rest.get(f"/v1/runs/{run}").status_code == 404


def test_a_run_that_is_resumed_before_its_pause_is_reported_is_not_told_as_paused(
    service: ServiceProcess, rest: httpx.Client
) -> None:
    with ServiceClient(service) as owner:
        run = owner.do(protocol.StartRun, case="dam-break", duration=1e6)["run"]
        owner.do(protocol.Subscribe, run=run)
        owner.frame(run, 1)
        for _ in range(5):
            assert rest.post(f"/v1/runs/{run}/pause").status_code == 204
            assert rest.post(f"/v1/runs/{run}/resume").status_code == 204
            count = rest.get(f"/v1/runs/{run}").json()["frame_count"]
            owner.first(protocol.Frame, lambda frame, count=count: frame.index >= count)
            assert status(rest, run) == "running"
        owner.do(protocol.StopRun, run=run)


@pytest.mark.parametrize("path", ["/v1/runs/none/pause", "/v1/runs/none/resume", "/v1/runs/none/pin"])
def test_an_action_on_a_run_that_is_not_there_is_told(rest: httpx.Client, path: str) -> None:
    answer = rest.post(path)
    assert answer.status_code == 409
    assert "there is no run 'none'" in answer.json()["detail"]


@pytest.mark.parametrize("path", ["/v1/runs/r1/explode", "/v1/runs/a%20b/pause", "/v1/runs/r1/Pause"])
def test_an_action_or_name_that_is_none_is_refused(rest: httpx.Client, path: str) -> None:
    assert rest.post(path).status_code == 422


def test_a_move_that_is_not_legal_is_told(rest: httpx.Client) -> None:
    run = rest.post("/v1/runs", json={"case": "dam-break", "paused": True}).json()["run"]
    assert rest.post(f"/v1/runs/{run}/stop").status_code == 204
    answer = rest.post(f"/v1/runs/{run}/resume")
    assert answer.status_code == 409
    assert "stopped" in answer.json()["detail"]


def test_a_connection_is_ended_with_a_reason_and_no_other(
    service: ServiceProcess, rest: httpx.Client
) -> None:
    with ServiceClient(service) as kept:
        before = {stream["session"] for stream in rest.get("/v1/connections").json()}
        with ServiceClient(service) as ended:
            (name,) = {stream["session"] for stream in rest.get("/v1/connections").json()} - before
            assert rest.delete(f"/v1/connections/{name}").status_code == 204
            with pytest.raises(ConnectionClosed) as close:
                ended.until(lambda event: False, timeout_s=5.0)
            assert close.value.rcvd is not None
            assert close.value.rcvd.code == 1008
            assert "an operator has ended" in close.value.rcvd.reason
        assert isinstance(kept.ask(protocol.ListRuns), protocol.RunList)
    assert rest.delete("/v1/connections/s000000000000").status_code == 404
