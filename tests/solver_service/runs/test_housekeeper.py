from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from solver_service.runs import RoomRules, Run, RunStatus
from solver_service.runs.housekeeper import Housekeeper
from solver_service.store import RunDatabase
from tests.solver_service.runs.conftest import Service

QUIET = RoomRules(interval_s=3600.0)


@pytest.fixture
def service(tmp_path: Path, case: str) -> Iterator[Service]:
    service = Service(tmp_path, cases=(case,), threads=2, room=QUIET, checkpoint_interval_s=0.02)
    yield service
    service.close()


def housekeeper(service: Service, **rules: int) -> Housekeeper:
    registry = service.registry
    database = RunDatabase(registry._folder.database)
    epoch = database._db.execute("SELECT value FROM service").fetchone()[0]
    database.close()
    return Housekeeper(
        registry.control,
        registry.tree,
        registry._store,
        registry._folder,
        registry.reports,
        replace(QUIET, **rules),
        epoch,
    )


def used(service: Service) -> int:
    async def ask() -> int:
        stored = await service.registry._store.call(RunDatabase.stored_bytes)
        return sum(each.size for each in stored)

    return service.call(ask())


def finished(service: Service, duration: float = 50.0) -> Run:
    run = service.call(service.registry.control.start("dam-break", duration))
    service.wait_for_status(run, RunStatus.FINISHED)
    return run


def test_a_budget_lets_old_runs_go_and_keeps_pinned_and_living_ones(service: Service) -> None:
    registry = service.registry
    pinned, old, new = finished(service), finished(service), finished(service)
    service.call(registry.control.pin(pinned.run))
    paused = service.call(registry.control.start("dam-break", 1e4, paused=True))
    service.wait(lambda: paused.status is RunStatus.PAUSED and paused.frame_count > 0)
    service.call(registry.supervisor.settle(old))
    frames = sum(frame.size for run in (pinned, old, new) for frame in run.frames)
    keeper = housekeeper(service, store_bytes=used(service) - 1000)
    service.call(keeper.look())
    assert old.run in registry.tree, "a checkpoint is enough"
    keeper = housekeeper(service, store_bytes=frames // 3)
    service.call(keeper.look())
    assert old.run not in registry.tree
    assert new.run not in registry.tree
    assert pinned.run in registry.tree
    assert paused.run in registry.tree
    assert any("was deleted: the store had no room left" in text for text in service.notices(old.run))


def test_when_nothing_may_go_runs_pause_in_words_and_go_on_when_there_is_room(service: Service) -> None:
    run = service.call(service.registry.control.start("dam-break", 1e4))
    service.wait(lambda: run.frame_count > 3)
    service.call(housekeeper(service, store_bytes=1).look())
    assert run.status is RunStatus.PAUSED
    assert "there is no room in" in run.reason
    assert "nothing more may" in run.reason
    stored = run.frame_count
    service.call(housekeeper(service, store_bytes=1).look())
    assert run.status is RunStatus.PAUSED
    service.call(housekeeper(service, store_bytes=1 << 40).look())
    service.wait(lambda: run.frame_count > stored + 3)
    service.call(service.registry.control.stop(run.run))


def test_a_run_that_a_person_paused_does_not_go_on_by_itself(service: Service) -> None:
    run = service.call(service.registry.control.start("dam-break", 1e4))
    service.wait(lambda: run.status is RunStatus.RUNNING)
    service.call(service.registry.control.pause(run.run))
    service.call(housekeeper(service).look())
    assert run.status is RunStatus.PAUSED


def test_the_segments_of_a_run_that_was_paused_often_are_moved_together(service: Service) -> None:
    registry = service.registry
    run = service.call(registry.control.start("dam-break", 200.0, paused=True))
    service.wait(lambda: run.status is RunStatus.PAUSED and run.frame_count > 0)
    other = service.call(registry.control.start("dam-break", 1e4, paused=True))
    assert run.worker is not None
    run.worker.kill()
    service.wait(lambda: run.worker is None)
    service.call(registry.control.resume(run.run))
    service.wait_for_status(run, RunStatus.FINISHED)
    assert len({frame.segment for frame in run.frames}) == 2
    before = [service.call(registry.read_frame(frame)) for frame in run.frames]
    rows = list(run.frames)
    keeper = housekeeper(service)
    service.wait(lambda: run.worker is not None and run.run not in run.worker.holds)
    service.call(keeper.look())
    assert len({frame.segment for frame in run.frames}) == 1
    assert [service.call(registry.read_frame(frame)) for frame in run.frames] == before
    assert [service.call(registry.read_frame(row)) for row in rows] == before, "old rows are found, too"
    assert other.run in registry.tree


def test_a_reserve_on_the_disk_counts_like_a_budget(service: Service) -> None:
    run = finished(service)
    service.call(housekeeper(service, reserve_bytes=1 << 60).look())
    assert run.run not in service.registry.tree
