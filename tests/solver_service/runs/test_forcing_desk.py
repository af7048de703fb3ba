"""The forcing of a branch: a working list like that of edits, and a child that it drives from then on."""

import os
import signal
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from protocol import ForcingChange, ForcingChanged, ForcingError, ForcingSeries, WaterBudget
from solver_service.errors import RunError
from solver_service.runs import Run, RunStatus
from solver_service.runs.event_log import LoggedForcing, is_same, read_event_log, replay
from solver_service.store import DataFolder, RunDatabase
from tests.end_to_end.forced_basin import write_forced_basin
from tests.solver_service.runs.conftest import Service

LAST = 20
FLOOD = (
    ForcingChange("spring", 3.0),
    ForcingChange("river", series=ForcingSeries((50.0, 120.0), (10.0, 90.0))),
    ForcingChange("sea", offset=0.4),
    ForcingChange("rain", 2.0),
)


@pytest.fixture(scope="module")
def basin(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(write_forced_basin(tmp_path_factory.mktemp("case") / "basin"))


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory, basin: str) -> Iterator[Service]:
    dry = str(write_forced_basin(tmp_path_factory.mktemp("case") / "dry", name="dry", rain=False))
    data_dir = tmp_path_factory.mktemp("data")
    service = Service(data_dir, cases=(basin, dry), threads=1, checkpoint_interval_s=0.02)
    yield service
    service.close()


@pytest.fixture(scope="module")
def root(service: Service) -> Run:
    run = service.call(service.registry.control.start("basin"))
    service.wait_for_status(run, RunStatus.FINISHED)
    return run


def branch(service: Service, run: Run, index: int, *changes: ForcingChange) -> Run:
    service.call(service.registry.forcing.change(run.run, changes))
    return service.call(service.registry.branching.recalculate(run.run, index, 0))


def packed(service: Service, run: Run) -> list[bytes]:
    """The frames of a run without its name."""
    frames = [service.call(service.registry.read_frame(frame)) for frame in run.frames]
    return [frame.partition(run.run.encode())[2] for frame in frames]


def budget(service: Service, run: Run) -> WaterBudget:
    """Where the water of a finished run came from and went."""

    def told() -> list[WaterBudget]:
        return [
            m for m in service.heard if isinstance(m, WaterBudget) and (m.run, m.time) == (run.run, 200.0)
        ]

    service.wait(lambda: bool(told()))
    return told()[-1]


def kill(run: Run) -> None:
    assert run.worker is not None
    assert run.worker.pid is not None
    os.kill(run.worker.pid, signal.SIGKILL)


def test_a_list_that_fits_is_told_with_a_revision_and_another_is_refused(
    service: Service,
) -> None:
    run = service.call(service.registry.control.start("basin", paused=True))
    service.wait(lambda: run.frame_count > 0)
    forcing = service.registry.forcing
    assert service.call(forcing.change(run.run, FLOOD)) == 1
    assert service.call(forcing.change(run.run, FLOOD[:1])) == 2
    told = [m for m in service.heard if isinstance(m, ForcingChanged) and m.run == run.run]
    assert [(m.revision, m.changes, m.applied) for m in told] == [(1, FLOOD, ()), (2, FLOOD[:1], ())]
    assert [item.id for item in told[0].items] == ["spring", "river", "sea", "rain", "dike", "low"]
    with pytest.raises(ForcingError, match="no forcing 'lake'"):
        service.call(forcing.change(run.run, (ForcingChange("lake"),)))
    with pytest.raises(RunError, match=r"forcing of run .* is at revision 2, not 1"):
        service.call(service.registry.branching.recalculate(run.run, 0, 0, forcing_revision=1))
    assert service.registry.tree.info(run).forcing_revision == 2
    service.call(service.registry.control.stop(run.run))


def test_a_branch_brings_the_changed_water_from_its_time_on_and_its_books_close(
    service: Service, root: Run
) -> None:
    child = branch(service, root, 8, *FLOOD)
    service.wait_for_status(child, RunStatus.FINISHED)
    found, base = budget(service, child), budget(service, root)
    assert found.sources["spring"] == pytest.approx(5.0 * 80.0 + 15.0 * 120.0, abs=0.1)
    river = 0.5 * 30.0 * 40.0 + 50.0 * (40.0 + 0.5 * 50.0 * 20.0 / 170.0)
    at_branch = 10.0 + 80.0 * 30.0 / 70.0
    river += 40.0 * 0.5 * (at_branch + 90.0) + 80.0 * 90.0
    assert found.edges_in["river"] == pytest.approx(river, rel=2e-3)
    assert found.rain - base.rain == pytest.approx(base.rain * 4760.0 / 7000.0, rel=0.02)
    assert found.edges_in["sea"] > 1.2 * base.edges_in["sea"]
    assert abs(found.error_relative) < 1e-8
    changed = service.registry.forcing.changed(child.run)
    assert (changed.changes, changed.applied) == (FLOOD, FLOOD)


def test_a_branch_without_a_change_goes_on_as_its_parent_does(service: Service, root: Run) -> None:
    first = branch(service, root, 8)
    again = branch(service, root, 8, ForcingChange("spring"), ForcingChange("dike"))
    for run in (first, again):
        service.wait_for_status(run, RunStatus.FINISHED)
    assert packed(service, first) == packed(service, again)
    assert budget(service, first).stored == budget(service, root).stored


def test_a_killed_worker_and_a_branch_of_a_branch_bring_the_very_bytes_of_an_undisturbed_one(
    service: Service, root: Run, basin: str
) -> None:
    child = branch(service, root, 5, *FLOOD[:2])
    service.wait(lambda: child.frame_count > 11)
    grandchild = branch(service, child, 11, *FLOOD[2:], ForcingChange("spring", 0.0))
    service.wait(lambda: grandchild.frame_count > 13)
    if grandchild.status is not RunStatus.FINISHED:
        kill(grandchild)
    service.wait_for_status(grandchild, RunStatus.FINISHED)
    folder = DataFolder(service.registry._folder.root)
    for run in (root, child, grandchild):  # no checkpoint and no memory of the lineage is left
        for path in folder.checkpoints(run.run).glob("*/c/**/*"):
            if path.is_file():
                path.write_bytes(b"torn")
    workers = list(service.registry.pool.workers)
    for worker in workers:
        worker.kill()
    service.wait(lambda: all(worker.is_dead for worker in workers))
    cold = branch(service, child, 11, *FLOOD[2:], ForcingChange("spring", 0.0))
    service.wait_for_status(cold, RunStatus.FINISHED)
    assert packed(service, cold) == packed(service, grandchild)
    database = RunDatabase(folder.database)
    log = read_event_log(database, grandchild.run)
    database.close()
    frames = list(replay(log, basin, threads=1))
    assert [frame.index for frame, _ in frames] == list(range(11, LAST + 1))
    assert all(is_same(frame, bytes_) for frame, bytes_ in frames)
    assert [event.revision for event in log.events if isinstance(event, LoggedForcing)] == [
        grandchild.forcing.revision
    ]
    legs = (*log.run.legs[:-1], msgspec.structs.replace(log.run.legs[-1], forcing=()))
    other = replace(log, run=msgspec.structs.replace(log.run, legs=legs))
    assert not all(is_same(frame, bytes_) for frame, bytes_ in replay(other, basin, threads=1))


def test_a_breach_is_put_off_or_begins_at_once_but_is_not_taken_back(service: Service, root: Run) -> None:
    registry = service.registry
    never = branch(service, root, 4, ForcingChange("dike", start_time="never"))
    at_once = branch(service, root, 2, ForcingChange("dike", start_time=20.0))
    for run in (never, at_once):
        service.wait_for_status(run, RunStatus.FINISHED)
    assert len({packed(service, run)[-1] for run in (never, at_once, root)}) == 3
    before = len(list(registry.tree))
    with pytest.raises(RunError, match="the breach 'dike' has begun at 60 s, before the branch at 80 s"):
        branch(service, root, 8, ForcingChange("dike", start_time="never"))
    with pytest.raises(RunError, match="'dike' would begin at 30 s, before the branch at 50 s"):
        branch(service, root, 5, ForcingChange("dike", start_time=30.0))
    assert len(list(registry.tree)) == before


def test_a_breach_that_the_water_has_begun_keeps_its_course_and_a_notice_says_so(
    service: Service, root: Run
) -> None:
    late = branch(service, root, 15, ForcingChange("low", start_time="never"))
    service.wait_for_status(late, RunStatus.FINISHED)
    service.wait(lambda: bool(service.notices(late.run)))
    assert "the breach 'low' had begun at 106" in service.notices(late.run)[0]
    same = branch(service, root, 15, ForcingChange("low", start_time=180.0))
    early = branch(service, root, 9, ForcingChange("low", start_time="never"))
    for run in (same, early):
        service.wait_for_status(run, RunStatus.FINISHED)
    assert packed(service, late) == packed(service, same)
    assert packed(service, early)[-1] != packed(service, same)[-1]
    assert service.notices(early.run) == []


def test_a_run_may_start_with_another_forcing_and_rain_may_come_to_a_dry_case(service: Service) -> None:
    registry = service.registry
    rain = ForcingChange("rain", series=ForcingSeries((0.0,), (60.0,)))
    wet = service.call(registry.control.start("dry", forcing=(rain, ForcingChange("spring", 0.0))))
    assert registry.forcing.changed(wet.run).applied[0] == rain
    dry = service.call(registry.control.start("dry"))
    for run in (wet, dry):
        service.wait_for_status(run, RunStatus.FINISHED)
    cells = 40 * 60 * 100.0
    assert budget(service, wet).rain == pytest.approx(0.06 / 3600.0 * 200.0 * cells, rel=0.01)
    assert budget(service, wet).sources["spring"] == 0.0
    later = branch(service, dry, 10, rain)
    service.wait_for_status(later, RunStatus.FINISHED)
    found = budget(service, later)
    assert found.rain == pytest.approx(0.06 / 3600.0 * 100.0 * cells, rel=0.02)
    assert abs(found.error_relative) < 1e-8
    torrent = ForcingChange("spring", series=ForcingSeries((0.0,), (1e7,)))
    with pytest.raises(ForcingError, match="'spring' comes to"):
        service.call(registry.control.start("dry", forcing=(torrent,)))


def test_the_working_forcing_outlives_the_service(tmp_path: Path, basin: str) -> None:
    service = Service(tmp_path, cases=(basin,), threads=1, spare_workers=0)
    run = service.call(service.registry.control.start("basin", paused=True))
    service.wait(lambda: run.frame_count > 0)
    child = branch(service, run, 0, *FLOOD)
    service.wait(lambda: child.frame_count > 0)
    service.call(service.registry.forcing.change(child.run, FLOOD[:1]))
    service.close()
    service = Service(tmp_path, cases=(basin,), threads=1, spare_workers=0)
    told = service.registry.forcing.changed(child.run)
    assert (told.revision, told.changes, told.applied) == (2, FLOOD[:1], FLOOD)
    assert service.registry.forcing.changed(run.run).revision == 1
    service.close()
