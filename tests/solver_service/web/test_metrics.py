import re
from pathlib import Path

import httpx

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from solver_service.web.metrics import Family, unready_reason

SAMPLE = re.compile(r'([a-z_]+)(?:\{([a-z]+)="((?:[^"\\\n]|\\.)*)"\})? (\S+)')


def scraped(service: ServiceProcess) -> dict[tuple[str, str], float]:
    """The samples of /metrics by name and label value; every line must be of the text format."""
    headers = {"Authorization": f"Bearer {service.token}"}
    answer = httpx.get(f"{service.http}/metrics", headers=headers, timeout=30.0)
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "text/plain; version=0.0.4; charset=utf-8"
    assert answer.text.endswith("\n")
    samples = {}
    typed = set()
    for line in answer.text.splitlines():
        if line.startswith("# TYPE "):
            typed.add(line.split()[2])
        elif not line.startswith("# HELP "):
            match = SAMPLE.fullmatch(line)
            assert match is not None, line
            assert match[1] in typed
            assert (match[1], match[3] or "") not in samples
            samples[match[1], match[3] or ""] = float(match[4])
    return samples


def test_a_gauge_is_told_in_the_text_format() -> None:
    gauge = Family("fev_x_bytes", "What it is.", {(): 2, (("name", 'a"b\\c\nd'),): 0.5})
    assert gauge.lines() == [
        "# HELP fev_x_bytes What it is.",
        "# TYPE fev_x_bytes gauge",
        "fev_x_bytes 2",
        'fev_x_bytes{name="a\\"b\\\\c\\nd"} 0.5',
    ]


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
