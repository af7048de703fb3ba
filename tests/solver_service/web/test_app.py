"""REST against a real service process."""

import time

import httpx
import pytest

import protocol
from bench.service_process import ServiceClient, ServiceProcess


@pytest.fixture
def rest(service: ServiceProcess) -> httpx.Client:
    headers = {"Authorization": f"Bearer {service.token}"}
    with httpx.Client(base_url=service.http, headers=headers, timeout=60.0) as client:
        yield client


def test_health_needs_no_token_and_everything_else_does(service: ServiceProcess) -> None:
    with httpx.Client(base_url=service.http) as stranger:
        assert stranger.get("/healthz").json() == {"status": "ok"}
        for path in ("/version", "/v1/status", "/v1/cases", "/v1/runs", "/v1/runs/r1"):
            answer = stranger.get(path)
            assert answer.status_code == 401, path
            assert answer.headers["www-authenticate"] == "Bearer"
        assert stranger.post("/v1/runs", json={"case": "dam-break"}).status_code == 401
        assert stranger.get("/v1/runs", params={"token": service.token}).status_code == 401


def test_the_version_names_the_protocol(rest: httpx.Client) -> None:
    assert rest.get("/version").json()["protocol"] == "fev.v1"


def test_the_cases_on_offer_are_listed(rest: httpx.Client) -> None:
    cases = {case["name"]: case for case in rest.get("/v1/cases").json()}
    assert {"dam-break", "jacksboro"} <= set(cases)
    assert cases["dam-break"]["nrows"] == 96
    assert cases["jacksboro"]["hypothetical"]


def test_a_run_is_started_and_watched(rest: httpx.Client) -> None:
    answer = rest.post("/v1/runs", json={"case": "dam-break", "duration": 20.0})
    assert answer.status_code == 201
    run = answer.json()["run"]
    ends = time.monotonic() + 30.0
    while (info := rest.get(f"/v1/runs/{run}").json())["status"] != "finished":
        assert time.monotonic() < ends
        time.sleep(0.05)
    assert info["frame_count"] == 5
    assert run in [listed["run"] for listed in rest.get("/v1/runs").json()]
    assert rest.get("/v1/status").json()["runs"] >= 1


def test_a_run_keeps_the_channels_that_it_is_asked_to(rest: httpx.Client) -> None:
    asked = (({"channels": ["maxima"]}, ["maxima"]), ({"channels": []}, None), ({}, ["velocity", "maxima"]))
    for body, kept in asked:
        run = rest.post("/v1/runs", json={"case": "dam-break", "duration": 5.0, **body}).json()["run"]
        assert (rest.get(f"/v1/runs/{run}").json().get("channels") or None) == kept


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({"case": "atlantis"}, 409),
        ({"case": "../../etc/passwd"}, 409),
        ({"case": "dam-break", "duration": -1.0}, 422),
        ({"case": "dam-break", "output_interval": 0.0}, 422),
        ({"case": "dam-break", "channels": ["tides"]}, 422),
        ({"case": "dam-break", "device": "tpu"}, 422),
        ({}, 422),
    ],
)
def test_a_run_that_cannot_be_is_refused_in_words(
    rest: httpx.Client, body: dict[str, object], status: int
) -> None:
    before = [run["run"] for run in rest.get("/v1/runs").json()]
    answer = rest.post("/v1/runs", json=body)
    assert answer.status_code == status
    assert answer.json()["detail"]
    assert [run["run"] for run in rest.get("/v1/runs").json()] == before


def test_a_run_that_is_not_there_is_not_found(rest: httpx.Client) -> None:
    assert rest.get("/v1/runs/r000").status_code == 404
    assert rest.get("/v1/runs/..%2F..%2Fetc").status_code == 404


def test_the_open_streams_are_listed_with_who_and_what(service: ServiceProcess, rest: httpx.Client) -> None:
    run = rest.post("/v1/runs", json={"case": "dam-break", "paused": True}).json()["run"]
    before = {stream["session"] for stream in rest.get("/v1/connections").json()}
    with ServiceClient(service) as client:
        client.do(protocol.Subscribe, run=run)
        (stream,) = (s for s in rest.get("/v1/connections").json() if s["session"] not in before)
        assert (stream["client"], stream["run"], stream["scope"]) == ("fev-bench", run, "operator")
        assert stream["token"] == "token file"
        assert stream["address"].startswith("127.0.0.1:")
        assert abs(time.time() - stream["since"]) < 60.0
        name = stream["session"]
    ends = time.monotonic() + 10.0
    while name in {s["session"] for s in rest.get("/v1/connections").json()}:
        assert time.monotonic() < ends
        time.sleep(0.05)
