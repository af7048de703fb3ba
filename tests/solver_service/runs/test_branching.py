import contextlib

from solver_service.errors import RunError
from solver_service.runs import Run, RunStatus
from tests.end_to_end.dam_break import levee
from tests.solver_service.runs.conftest import Service

DURATION = 400.0


def start(service: Service) -> Run:
    run = service.call(service.registry.control.start("dam-break", DURATION))
    service.wait(lambda: run.frame_count > 0)
    return run


def test_a_child_that_is_recalculated_before_its_first_frame_still_gets_it(service: Service) -> None:
    registry = service.registry
    for _ in range(3):
        root = start(service)
        service.wait(lambda root=root: root.frame_count > 6)
        service.call(registry.edits.append(root.run, levee("a")))
        child = service.call(registry.branching.recalculate(root.run, 5, 1))
        service.call(registry.edits.append(child.run, levee("b", y=500.0)))
        grandchild = service.call(registry.branching.recalculate(child.run, 5, 2))
        service.wait(lambda grandchild=grandchild: grandchild.frame_count > 5)
        service.wait(lambda child=child: child.frame_count > 5)
        assert child.status is RunStatus.PAUSED
        assert grandchild.record.parent == root.run
        for run in (grandchild, child, root):
            with contextlib.suppress(RunError):  # finished meanwhile
                service.call(registry.control.stop(run.run))


def test_a_parent_resumed_at_once_on_another_worker_has_every_frame_once(service: Service) -> None:
    registry = service.registry
    for _ in range(3):
        root = start(service)
        service.wait(lambda root=root: root.frame_count > 8)
        child = service.call(registry.branching.recalculate(root.run, 3, 0))
        with contextlib.suppress(RunError):  # finished already
            service.call(registry.control.resume(root.run))
        for run in (root, child):
            service.wait_for_status(run, RunStatus.FINISHED)
        assert [frame.index for frame in root.frames] == list(range(81))
        assert [frame.index for frame in child.frames] == list(range(3, 81))
