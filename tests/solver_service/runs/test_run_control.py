import pytest

from protocol import RunRemoved
from solver_service.errors import RunError
from solver_service.runs import Run, RunStatus
from solver_service.store import DataFolder, remove_run_files
from tests.solver_service.runs.conftest import Service

DURATION = 400.0


def start(service: Service) -> Run:
    run = service.call(service.registry.control.start("dam-break", DURATION))
    service.wait(lambda: run.frame_count > 0)
    return run


def test_a_run_is_deleted_with_its_files_when_nothing_needs_it(service: Service) -> None:
    registry = service.registry
    root = start(service)
    service.wait(lambda: root.frame_count > 4)
    with pytest.raises(RunError, match="cannot be deleted; it can while it is"):
        service.call(registry.control.delete(root.run))
    child = service.call(registry.branching.recalculate(root.run, 2, 0))
    service.wait(lambda: child.frame_count > 2)
    with pytest.raises(RunError, match=f"holds the past of {child.run}"):
        service.call(registry.control.delete(root.run))
    service.call(registry.control.stop(child.run))
    service.call(registry.control.pin(child.run))
    with pytest.raises(RunError, match="is pinned"):
        service.call(registry.control.delete(child.run))
    service.call(registry.control.pin(child.run, False))
    folder = registry._folder
    for run in (child, root):
        assert folder.frames(run.run).is_dir()
        service.call(registry.control.delete(run.run))
        assert run.run not in registry.tree
        assert not folder.frames(run.run).exists()
        assert not folder.checkpoints(run.run).exists()
        assert RunRemoved(run.run) in service.heard
    with pytest.raises(RunError, match="there is no run"):
        service.call(registry.control.delete(root.run))


def test_everybody_has_heard_that_a_run_is_gone_before_its_files_go(
    service: Service, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = start(service)
    service.call(service.registry.control.stop(run.run))
    heard = []

    def remove(folder: DataFolder, name: str) -> None:
        heard.append(RunRemoved(name) in service.heard)
        remove_run_files(folder, name)

    monkeypatch.setattr("solver_service.runs.run_control.remove_run_files", remove)
    service.call(service.registry.control.delete(run.run))
    assert heard == [True], "whoever watches would ask for frames of a run that is not there"


def test_a_run_of_which_every_frame_is_stored_is_finished_by_resuming_it(service: Service) -> None:
    run = start(service)
    service.wait_for_status(run, RunStatus.FINISHED)
    service.call(service.registry.supervisor.settle(run))
    if run.worker is not None:
        run.worker.kill()
        service.wait(lambda: run.worker is None)
    run.status, run.frames = RunStatus.PAUSED, run.frames[:-1]  # as after the death of a service
    service.call(service.registry.control.resume(run.run))
    assert run.status is RunStatus.FINISHED
    assert run.frame_count == run.last_index + 1
    with pytest.raises(RunError, match="is finished and cannot be resumed"):
        service.call(service.registry.control.resume(run.run))


def test_a_label_and_a_pin_are_told_and_kept(service: Service) -> None:
    registry = service.registry
    run = start(service)
    service.call(registry.control.rename(run.run, "with the levee"))
    service.call(registry.control.pin(run.run))
    info = registry.tree.info(run)
    assert (info.label, info.pinned) == ("with the levee", True)
    service.call(registry.control.stop(run.run))
