"""What the holder of a token may take, against a real service process, and the GPU's memory by rows."""

import asyncio
import sqlite3
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from solver_service.errors import QuotaError
from solver_service.numerics import MemoryOptions, allocation_table, device_bytes
from solver_service.runs import RunRegistry
from solver_service.web.auth import LOCAL, Access
from solver_service.web.quotas import Quotas
from solver_service.web.scopes import Scope
from solver_service.web.token_limits import TokenLimits
from solver_service.web.token_store import TokenStore
from tests.end_to_end.dam_break import CELLS, levee, write_dam_break

LONG = 1e6
"""Simulated time that no test waits for [s]."""
GRID_CELLS = CELLS * CELLS


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(write_dam_break(tmp_path_factory.mktemp("case") / "dam-break"))


@pytest.fixture(scope="module")
def limited(tmp_path_factory: pytest.TempPathFactory, case: str) -> Iterator[ServiceProcess]:
    """A service whose settings allow two streams and 50 runs to whoever has no other limits."""
    folder = tmp_path_factory.mktemp("data")
    options: dict[str, Any] = {"cases": [case], "threads": 1, "max_viewers": 2, "max_runs": 50}
    with ServiceProcess(folder, **options) as service:
        yield service


class Holder:
    """Somebody with a token of its own, by REST and by the stream."""

    def __init__(self, service: ServiceProcess, **limits: int) -> None:
        store = TokenStore(service.data_dir)
        self.token, record = store.create("test", Scope.OPERATOR, None, TokenLimits(**limits))
        store.close()
        self.id = record.id
        self.service = service
        self.headers = {"Authorization": f"Bearer {self.token}"}

    def start(self, **body: object) -> httpx.Response:
        body = {"case": "dam-break", "paused": True, **body}
        return httpx.post(f"{self.service.http}/v1/runs", json=body, headers=self.headers, timeout=60.0)

    def started(self, **body: object) -> str:
        answer = self.start(**body)
        assert answer.status_code == 201, answer.text
        return str(answer.json()["run"])

    def stream(self, resume: protocol.ResumePoint | None = None) -> ServiceClient:
        holder = ServiceProcess(self.service.data_dir)
        holder.url, holder.http, holder.token = self.service.url, self.service.http, self.token
        return ServiceClient(holder, resume)


def refused(answer: protocol.Error, limit: str, *numbers: int) -> None:
    assert answer.code == "over_quota", answer
    assert f"({limit})" in answer.message
    for number in numbers:
        assert str(number) in answer.message.split(), answer.message


def stop(client: ServiceClient, *runs: str) -> None:
    for run in runs:
        client.ask(protocol.TakeControl, run=run, force=True)
        client.ask(protocol.StopRun, run=run)


def refusals(service: ServiceProcess, limit: str) -> float:
    headers = {"Authorization": f"Bearer {service.token}"}
    text = httpx.get(f"{service.http}/metrics", headers=headers, timeout=30.0).text
    (line,) = [x for x in text.splitlines() if x.startswith(f'fev_quota_refusals_total{{limit="{limit}"}}')]
    return float(line.split()[1])


def test_a_token_keeps_so_many_runs_and_not_one_more_until_one_is_deleted(limited: ServiceProcess) -> None:
    few, other = Holder(limited, max_runs=2), Holder(limited, max_runs=1)
    before = refusals(limited, "max_runs")
    runs = [few.started(), few.started()]
    answer = few.start()
    assert answer.status_code == 429
    assert answer.json()["code"] == "over_quota"
    assert "3 runs kept" in answer.json()["detail"]
    assert "2 are allowed (max_runs)" in answer.json()["detail"]
    listed = httpx.get(f"{limited.http}/v1/runs", headers=few.headers).json()
    assert len([run for run in listed if run["run"] in runs]) == 2
    assert refusals(limited, "max_runs") == before + 1

    neighbour = other.started()
    with few.stream() as client:
        refused(client.ask(protocol.StartRun, case="dam-break", paused=True), "max_runs", 3, 2)
        refused(client.ask(protocol.Recalculate, run=runs[0], index=0, revision=0), "max_runs", 3, 2)
        stop(client, *runs, neighbour)
        client.do(protocol.DeleteRun, run=runs[0])
        client.do(protocol.StartRun, case="dam-break", paused=True)
    assert refusals(limited, "max_runs") == before + 3


def test_of_two_starts_at_once_exactly_one_takes_the_last_place(limited: ServiceProcess) -> None:
    for _ in range(3):
        holder = Holder(limited, max_runs=1)
        with ThreadPoolExecutor(2) as pool:
            answers = list(pool.map(lambda _, holder=holder: holder.start(), range(2)))
        assert sorted(answer.status_code for answer in answers) == [201, 429]
        with holder.stream() as client:
            stop(client, *(a.json()["run"] for a in answers if a.status_code == 201))


def test_the_cells_of_what_computes_are_limited_and_what_waits_is_free(limited: ServiceProcess) -> None:
    holder = Holder(limited, max_cells=2 * GRID_CELLS - 1)
    first = holder.started(duration=LONG, paused=False)
    answer = holder.start()
    assert answer.status_code == 429
    assert f"{2 * GRID_CELLS} cells" in answer.json()["detail"]
    assert f"{2 * GRID_CELLS - 1} are allowed (max_cells)" in answer.json()["detail"]
    with holder.stream() as client:
        client.first(protocol.RunChanged, lambda m: m.run.run == first and m.run.frame_count > 0)
        client.do(protocol.TakeControl, run=first, force=True)
        refused(
            client.ask(protocol.Recalculate, run=first, index=0, revision=0, keep_parent=True), "max_cells"
        )
        client.do(protocol.PauseRun, run=first)
        second = client.do(protocol.StartRun, case="dam-break", duration=LONG)["run"]
        refused(client.ask(protocol.ResumeRun, run=first), "max_cells", 2 * GRID_CELLS)
        client.first(protocol.RunChanged, lambda m: m.run.run == second and m.run.frame_count > 0)
        # the child takes the place of its parent, which pauses
        child = client.do(protocol.Recalculate, run=second, index=0, revision=0)["run"]
        stop(client, first, second, child)


def test_edits_are_limited_within_a_second_and_a_refused_bundle_counts_nothing(
    limited: ServiceProcess,
) -> None:
    holder = Holder(limited, max_edits_per_s=3)
    run = holder.started()
    with holder.stream() as client:
        client.do(protocol.TakeControl, run=run, force=True)
        bundle = tuple(levee(f"b{n}", y=300.0 + 40.0 * n) for n in range(4))
        refused(client.ask(protocol.AppendEdits, run=run, edits=bundle), "max_edits_per_s", 4, 3)
        client.do(protocol.AppendEdits, run=run, edits=bundle[:2])
        client.do(protocol.AppendEdit, run=run, edit=levee("c", y=500.0))
        refused(client.ask(protocol.UndoEdit, run=run), "max_edits_per_s", 4, 3)
        time.sleep(1.05)
        assert client.do(protocol.UndoEdit, run=run)["revision"] == 3
        stop(client, run)


def test_streams_are_limited_and_the_successor_of_a_lost_one_is_let_in(limited: ServiceProcess) -> None:
    holder = Holder(limited, max_viewers=1)
    with holder.stream() as first:
        with pytest.raises((ConnectionClosed, protocol.ProtocolError)) as end, holder.stream() as second:
            pytest.fail(f"let in: {second}")
        assert "2 open streams" in str(end.value)
        session = first.session.welcome.session  # type: ignore[union-attr]
        with holder.stream(protocol.ResumePoint("none", 0, 0, session)) as successor:
            assert isinstance(successor.ask(protocol.ListRuns), protocol.RunList)
    deadline = time.monotonic() + 10.0
    while True:  # the service learns of the end a moment after us
        try:
            with holder.stream() as again:
                assert isinstance(again.ask(protocol.ListRuns), protocol.RunList)
            return
        except (ConnectionClosed, protocol.ProtocolError):
            assert time.monotonic() < deadline


def test_the_limits_of_the_settings_are_for_all_holders_of_the_token_file_together(
    limited: ServiceProcess,
) -> None:
    with ServiceClient(limited), ServiceClient(limited):
        with pytest.raises((ConnectionClosed, protocol.ProtocolError)) as end, ServiceClient(limited):
            pass
        assert "3 open streams are too many for the token file; 2 are allowed" in str(end.value)
        with Holder(limited).stream() as other:  # no limits of its own: the same number, for itself
            assert isinstance(other.ask(protocol.ListRuns), protocol.RunList)


def test_a_run_that_fills_the_disk_of_its_token_waits_and_more_is_refused_until_one_is_deleted(
    limited: ServiceProcess,
) -> None:
    holder, neighbour = Holder(limited, max_disk_bytes=60_000), Holder(limited)
    with holder.stream() as client, neighbour.stream() as other:
        run = client.do(protocol.StartRun, case="dam-break", duration=LONG)["run"]
        notice = client.first(protocol.Notice, lambda m: m.run == run)
        assert "60000 allowed (max_disk_bytes)" in notice.text
        client.first(protocol.RunChanged, lambda m: m.run.run == run and m.run.status == "paused")
        refused(client.ask(protocol.ResumeRun, run=run), "max_disk_bytes", 60_000)
        refused(client.ask(protocol.StartRun, case="dam-break", paused=True), "max_disk_bytes", 60_000)
        neighbours = other.do(protocol.StartRun, case="dam-break", paused=True)["run"]
        client.do(protocol.StopRun, run=run)
        client.do(protocol.DeleteRun, run=run)
        again = client.do(protocol.StartRun, case="dam-break", paused=True)["run"]
        stop(client, again, neighbours)


def test_what_a_token_has_taken_is_remembered_over_a_restart(tmp_path: Path, case: str) -> None:
    with ServiceProcess(tmp_path, cases=[case], threads=1) as service:
        holder = Holder(service, max_runs=1)
        run = holder.started()
    with ServiceProcess(tmp_path, cases=[case], threads=1) as service:
        holder.service = service
        assert holder.start().status_code == 429
        free = Holder(service, max_runs=1)
        assert free.start().status_code == 201
        store = TokenStore(service.data_dir)
        store.limit(holder.id, TokenLimits(max_runs=2))  # a raise counts at once
        store.close()
        assert holder.start().status_code == 201
        assert run in [r["run"] for r in httpx.get(f"{service.http}/v1/runs", headers=holder.headers).json()]


# what needs no process: sums over rows


GPU_BYTES = device_bytes(
    allocation_table(
        (CELLS, CELLS), MemoryOptions(rain=True, infiltration=True, infiltration_zones=True), "cuda:0"
    ),
    "cuda:0",
)


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory, case: str) -> Path:
    """A data folder with two paused runs of the token file that ask for a GPU."""
    folder = tmp_path_factory.mktemp("stored")

    async def make() -> None:
        registry = RunRegistry(folder, cases=(case,), spare_workers=0, threads=1)
        await registry.open()
        for _ in range(2):
            await registry.control.start("dam-break", paused=True)
        await registry.close()

    asyncio.run(make())
    with closing(sqlite3.connect(folder / "runs.sqlite")) as rows:
        rows.execute("UPDATE runs SET device = 'cuda:0', status = 'paused'")
        rows.commit()
    return folder


def test_the_memory_of_runs_on_a_gpu_is_limited_and_that_of_a_cpu_is_not(stored: Path, case: str) -> None:
    async def try_limits() -> None:
        registry = RunRegistry(stored, cases=(case,), spare_workers=0)
        await registry.open()
        tokens = TokenStore(stored)
        first, second = registry.tree
        quotas = Quotas(TokenLimits(max_gpu_bytes=2 * GPU_BYTES - 1), tokens, registry)
        try:
            async with quotas.resume(first):
                with pytest.raises(
                    QuotaError, match=rf"^{2 * GPU_BYTES} bytes of GPU .* {2 * GPU_BYTES - 1} are"
                ):
                    async with quotas.resume(second):
                        pytest.fail("allowed")
                async with quotas.start(LOCAL, "dam-break", "cpu"):
                    pass
                with pytest.raises(QuotaError):
                    async with quotas.start(LOCAL, "dam-break", "cuda:0"):
                        pytest.fail("allowed")
            async with quotas.resume(second):  # what was claimed and not taken is free again
                pass
            assert quotas.refusals["max_gpu_bytes"] == 2
        finally:
            tokens.close()
            await registry.close()

    asyncio.run(try_limits())


def test_room_on_the_disk_is_kept_while_something_is_written(stored: Path, case: str) -> None:
    async def try_limits() -> None:
        registry = RunRegistry(stored, cases=(case,), spare_workers=0)
        await registry.open()
        tokens = TokenStore(stored)
        taken = sum(each.size for each in await registry.stored_bytes())
        quotas = Quotas(TokenLimits(max_disk_bytes=taken + 1000), tokens, registry)
        uploads = {"": 0}
        quotas.count_disk(lambda owner: uploads[owner])
        try:
            async with quotas.disk(LOCAL, 600):
                async with quotas.disk(LOCAL, 400):
                    pass
                with pytest.raises(QuotaError, match=f"{taken + 1001} bytes on disk .* {taken + 1000} are"):
                    async with quotas.disk(LOCAL, 401):
                        pytest.fail("allowed")
                uploads[""] = 600
            async with quotas.disk(LOCAL, 400):
                pass
            with pytest.raises(QuotaError):
                async with quotas.disk(LOCAL, 401):
                    pytest.fail("allowed")
        finally:
            tokens.close()
            await registry.close()

    asyncio.run(try_limits())


def test_edits_leave_the_window_one_by_one(tmp_path: Path) -> None:
    clock = [0.0]
    tokens = TokenStore(tmp_path)
    registry: Any = None
    quotas = Quotas(TokenLimits(max_edits_per_s=2), tokens, registry, lambda: clock[0])
    guest = Access(Scope.CONTROLLER, None, "x")
    quotas.edit(guest, 1)
    clock[0] = 0.5
    quotas.edit(guest, 1)
    for clock[0], fits in ((0.999, False), (1.0, True), (1.2, False), (1.5, True)):
        if fits:
            quotas.edit(guest, 1)
        else:
            with pytest.raises(QuotaError):
                quotas.edit(guest, 1)
    tokens.close()
