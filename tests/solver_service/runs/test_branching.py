import contextlib

import numpy as np
import pytest

from protocol import BlockLayout, FrameDecoder, peek_frame
from solver_service.errors import RunError
from solver_service.runs import Run, RunStatus
from tests.end_to_end.dam_break import CELLS, levee
from tests.solver_service.runs.conftest import Service

DURATION = 200.0
COUNT = 41
LAYOUT = BlockLayout(CELLS, CELLS)


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
        assert [frame.index for frame in root.frames] == list(range(COUNT))
        assert [frame.index for frame in child.frames] == list(range(3, COUNT))


def test_a_child_beside_its_parent_does_not_depend_on_a_state_that_comes_too_late(
    service: Service, monkeypatch: pytest.MonkeyPatch
) -> None:
    registry = service.registry
    root = start(service)
    service.wait(lambda: root.frame_count > 6)
    monkeypatch.setattr("solver_service.runs.branching.SAVE_TIMEOUT_S", 0.0)
    child = service.call(registry.branching.recalculate(root.run, 5, 0, keep_parent=True))
    for run in (root, child):
        service.wait_for_status(run, RunStatus.FINISHED)
    packed = {
        run.run: [service.call(registry.read_frame(frame)) for frame in run.frames] for run in (root, child)
    }
    water = [
        {frame.index: decoder.decode(frame).q for frame in map(peek_frame, packed[run.run])}
        for run, decoder in ((root, FrameDecoder(LAYOUT)), (child, FrameDecoder(LAYOUT)))
    ]
    assert list(water[1]) == list(range(5, COUNT))
    assert all(np.array_equal(q, water[0][index]) for index, q in water[1].items())
