"""Uploads beside kills: nothing half-written stays; a run of an uploaded case goes on to the same bytes."""

import contextlib
import shutil
import time
from pathlib import Path

import httpx

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from solver_service.cli.event_log import replay_log, write_log
from tests.end_to_end.dam_break import write_dam_break
from tests.solver_service.uploads.archives import packed_folder


def killed(service: ServiceProcess) -> None:
    """End a service like a power cut does."""
    service.process.kill()
    service.process.wait()
    for pipe in (service.process.stdin, service.process.stdout):
        if pipe is not None:
            pipe.close()


def rest(service: ServiceProcess) -> httpx.Client:
    headers = {"Authorization": f"Bearer {service.token}"}
    return httpx.Client(base_url=service.http, headers=headers, timeout=60.0)


def uploaded(client: httpx.Client) -> list[str]:
    return [case["name"] for case in client.get("/v1/cases").json() if case["uploaded"]]


def until_over(client: httpx.Client, upload: str) -> dict[str, object]:
    end = time.monotonic() + 50.0
    while (facts := client.get(f"/v1/uploads/{upload}").json())["ended"] is None:
        assert time.monotonic() < end, facts
        time.sleep(0.05)
    return dict(facts)


def test_a_service_that_is_killed_while_a_case_comes_or_is_imported_has_it_whole_or_not_at_all(
    tmp_path: Path,
) -> None:
    archive = packed_folder(write_dam_break(tmp_path / "dam-break"))
    data = tmp_path / "data"
    # half sent
    service = ServiceProcess(data, spare_workers=0).__enter__()
    with rest(service) as client:

        def half() -> object:
            yield archive[: len(archive) // 2]
            end = time.monotonic() + 30.0
            while not any((data / "uploads").iterdir()) and time.monotonic() < end:
                time.sleep(0.01)
            killed(service)
            yield archive[len(archive) // 2 :]

        with contextlib.suppress(httpx.TransportError):
            client.post("/v1/uploads", content=half())
    assert any((data / "uploads").iterdir())  # what the cut left
    # in the middle of the import
    service = ServiceProcess(data, spare_workers=0).__enter__()
    with rest(service) as client:
        assert not any((data / "uploads").iterdir())
        assert uploaded(client) == []
        client.post("/v1/uploads", content=archive)
        time.sleep(0.2)  # an import takes longer than that, were it only to start its process
        killed(service)
    for kept in (data / "cases").iterdir():  # on a very fast machine
        assert (kept / "case" / "case.toml").exists()
        shutil.rmtree(kept)
    # now whole, and a run of it that is cut
    service = ServiceProcess(data, spare_workers=0, checkpoint_interval_s=0.05).__enter__()
    with rest(service) as client:
        assert uploaded(client) == []
        assert not any((data / "uploads").iterdir())
        facts = until_over(client, client.post("/v1/uploads", content=archive).json()["upload"])
        assert facts["status"] == "accepted", facts
        with ServiceClient(service) as viewer:
            run = viewer.do(protocol.StartRun, case="dam-break", duration=150.0)["run"]
            viewer.do(protocol.Subscribe, run=run)
            viewer.frame(run, 4)
            killed(service)
    with ServiceProcess(data, spare_workers=0) as service:
        with rest(service) as client:
            assert uploaded(client) == ["dam-break"]
        with ServiceClient(service) as viewer:
            viewer.do(protocol.ResumeRun, run=run)
            viewer.first(protocol.RunChanged, lambda e: (e.run.run, e.run.status) == (run, "finished"))
    write_log(run, tmp_path / "log.jsonl", data)
    assert replay_log(tmp_path / "log.jsonl", str(data / "cases" / "dam-break" / "case"), 1)
