import math
import time
from collections.abc import Callable
from pathlib import Path

import httpx
from prometheus_client.parser import text_string_to_metric_families

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from solver_service.web.metrics import unready_reason

Samples = dict[tuple[str, str], float]


def scraped(service: ServiceProcess) -> Samples:
    """The samples of /metrics by name and value of the first label."""
    headers = {"Authorization": f"Bearer {service.token}"}
    answer = httpx.get(f"{service.http}/metrics", headers=headers, timeout=30.0)
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "text/plain; version=0.0.4; charset=utf-8"
    samples: Samples = {}
    for family in text_string_to_metric_families(answer.text):
        assert family.documentation, family.name
        assert family.type in ("gauge", "counter", "histogram"), family.name
        for sample in family.samples:
            key = (sample.name, next(iter(sample.labels.values()), ""))
            assert key not in samples
            samples[key] = sample.value
    return samples


def scraped_until(service: ServiceProcess, test: Callable[[Samples], bool]) -> Samples:
    ends = time.monotonic() + 20.0
    while not test(samples := scraped(service)):
        assert time.monotonic() < ends, samples
        time.sleep(0.1)
    return samples


def test_the_metrics_follow_what_happens(service: ServiceProcess) -> None:
    before = scraped(service)
    with ServiceClient(service) as client:
        run = client.do(protocol.StartRun, case="dam-break", paused=True)["run"]
        during = scraped(service)
        assert during["fev_connections", ""] == before["fev_connections", ""] + 1
        client.do(protocol.StopRun, run=run)
        after = scraped(service)
    assert after["fev_runs", "stopped"] == before["fev_runs", "stopped"] + 1
    assert {label for name, label in before if name == "fev_runs"} == {
        "starting",
        "running",
        "paused",
        "finished",
        "stopped",
        "failed",
    }
    assert during["fev_workers_with_run", ""] >= 1
    assert during["fev_data_free_bytes", ""] > 0
    assert during["process_resident_memory_bytes", ""] > 1e7
    assert 0 < during["process_cpu_seconds_total", ""] < 1e4


def test_memory_and_time_of_each_worker_and_the_room_of_each_kind_are_told(service: ServiceProcess) -> None:
    with ServiceClient(service) as client:
        before = scraped(service)
        run = client.do(protocol.StartRun, case="dam-break", duration=50.0)["run"]
        client.first(protocol.RunChanged, lambda m: m.run.run == run and m.run.status == "finished")
        after = scraped_until(
            service, lambda s: s["fev_store_bytes", "checkpoints"] > before["fev_store_bytes", "checkpoints"]
        )
    assert after["fev_store_bytes", "frames"] > before["fev_store_bytes", "frames"]
    assert ("fev_store_bytes", "channels") in after
    workers = {label for name, label in after if name == "fev_worker_resident_memory_bytes"}
    assert len(workers) == after["fev_workers", ""] >= 1
    for worker in workers:
        assert 1e7 < after["fev_worker_resident_memory_bytes", worker] < 1e11
        assert 0.0 < after["fev_worker_cpu_seconds_total", worker] < 1e4


def test_the_lag_of_the_event_loop_is_a_histogram_that_goes_on(service: ServiceProcess) -> None:
    before = scraped(service)
    after = scraped_until(
        service,
        lambda s: (
            s["fev_event_loop_lag_seconds_count", ""] >= before["fev_event_loop_lag_seconds_count", ""] + 5
        ),
    )
    bounds = {
        float(label): value
        for (name, label), value in after.items()
        if name == "fev_event_loop_lag_seconds_bucket"
    }
    assert 0.02 in bounds  # the floor of the 99th percentile can be read off
    assert list(bounds.values()) == sorted(bounds.values())
    assert bounds[math.inf] == after["fev_event_loop_lag_seconds_count", ""]


def test_a_service_is_ready_while_it_can_write_its_runs(tmp_path: Path) -> None:
    with ServiceProcess(tmp_path / "data", spare_workers=0) as service:
        ready = httpx.get(f"{service.http}/readyz", timeout=30.0)
        assert (ready.status_code, ready.json()) == (200, {"status": "ready"})
        database = tmp_path / "data" / "runs.sqlite"
        database.rename(tmp_path / "away")
        unready = httpx.get(f"{service.http}/readyz", timeout=30.0)
        assert unready.status_code == 503
        assert str(tmp_path / "data") in unready.json()["reason"]
        assert httpx.get(f"{service.http}/healthz", timeout=30.0).status_code == 200
        (tmp_path / "away").rename(database)
        assert httpx.get(f"{service.http}/readyz", timeout=30.0).status_code == 200


def test_a_service_that_starts_or_ends_is_not_ready(tmp_path: Path) -> None:
    (tmp_path / "runs.sqlite").touch()
    assert unready_reason(True, tmp_path) is None
    assert unready_reason(False, tmp_path) == "the service is starting or ending"
