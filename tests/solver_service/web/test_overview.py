"""What the overview of a real service says, and differences between overviews."""

import json
import time
from collections.abc import Iterator
from typing import Any

import httpx

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from protocol import Notice, Progress, RunRemoved
from solver_service.web.overview import EVENTS_KEPT, Recent, changes


def overviews(service: ServiceProcess) -> Iterator[dict[str, Any]]:
    """The overview as it is after every event."""
    headers = {"Authorization": f"Bearer {service.token}"}
    now: dict[str, dict[str, Any]] = {}
    with httpx.stream("GET", f"{service.http}/v1/events", headers=headers, timeout=30.0) as answer:
        assert answer.headers["content-type"].startswith("text/event-stream")
        for line in answer.iter_lines():
            if line.startswith("data: "):
                news = json.loads(line.removeprefix("data: "))
                for section, rows in news["set"].items():
                    now.setdefault(section, {}).update(rows)
                for section, names in news["gone"].items():
                    for name in names:
                        del now[section][name]
                yield now


def test_runs_connections_workers_and_the_machine_are_told(service: ServiceProcess) -> None:
    with ServiceClient(service) as client:
        run = client.do(protocol.StartRun, case="dam-break", duration=1e6)["run"]
        client.do(protocol.Subscribe, run=run)
        client.do(protocol.RenameRun, run=run, label="the storm")
        client.frame(run, 1)
        for now in overviews(service):
            client.first(protocol.Frame)
            row = now["runs"].get(run, {})
            if row.get("speed") and row["label"] == "the storm" and now["connections"]:
                break
        assert row["status"] == "running"
        assert row["frames"] > 1
        assert row["cells"] == 96 * 96
        assert row["viewers"] == 1
        assert row["controller_client"] == "fev-bench"
        assert abs(row["volume_error"]) < 1e-6
        (connection,) = (c for c in now["connections"].values() if c["run"] == run)
        assert (connection["scope"], connection["token"]) == ("operator", "token file")
        assert connection["bytes_per_s"] >= 0.0
        assert now["devices"]["cpu"]["cells"] >= 96 * 96
        assert [w for w in now["workers"].values() if w["run"] == run and w["memory_bytes"] > 50e6]
        facts = now["service"]["service"]
        assert facts["computing"] >= 1
        assert 0 < facts["disk_free_bytes"] <= facts["disk_bytes"]
        assert 0 < facts["memory_bytes"] < facts["machine_memory_bytes"]
        client.do(protocol.StopRun, run=run)
        client.do(protocol.DeleteRun, run=run)
        assert next(True for now in overviews(service) if run not in now.get("runs", {}))


def test_at_most_two_differences_come_in_a_second(service: ServiceProcess) -> None:
    with ServiceClient(service) as client:
        run = client.do(protocol.StartRun, case="dam-break", duration=1e6)["run"]
        begun, moments = time.monotonic(), []
        for _ in overviews(service):
            moments.append(time.monotonic() - begun)
            if moments[-1] > 2.2:
                break
        client.do(protocol.StopRun, run=run)
        assert 2 <= len(moments) <= 7


def test_differences_name_what_is_new_changed_and_gone_and_nothing_else() -> None:
    before = {"runs": {"a": {"x": 1}, "b": {"x": 2}}, "events": {}}
    after = {"runs": {"a": {"x": 1}, "c": {"x": 3}}, "events": {}}
    assert changes(before, after) == {"set": {"runs": {"c": {"x": 3}}}, "gone": {"runs": ["b"]}}
    assert changes(after, after) is None
    assert changes({}, after) == {"set": {"runs": after["runs"]}, "gone": {}}


def test_the_latest_notices_and_progress_are_remembered_and_no_more() -> None:
    recent = Recent()
    for number in range(EVENTS_KEPT + 5):
        recent.announce(Notice("warning", f"notice {number}", "r1"))
    assert len(recent.events) == EVENTS_KEPT
    assert recent.events[-1]["text"] == f"notice {EVENTS_KEPT + 4}"
    assert recent.events[-1]["number"] == EVENTS_KEPT + 5
    recent.announce(Progress("r1", 1.0, 1, 0.1, 2.0, 1.0, 1.0, 0.0, 1))
    assert recent.progress["r1"].time == 1.0
    recent.announce(RunRemoved("r1"))
    assert recent.progress == {}
