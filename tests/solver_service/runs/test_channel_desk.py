"""Channels of real runs against the solver alone; branches, ancestors, and what is refused."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from protocol import BlockLayout, ChannelName, DecodedChannel, apply_edits, decode_channel, unpack_channel
from solver_service.errors import RunError, StoreError
from solver_service.numerics import ShallowWaterSolver
from solver_service.runs import Run, RunStatus
from solver_service.scenario import Case, load_case
from tests.end_to_end.dam_break import levee
from tests.solver_service.runs.conftest import Service

LAST = 10
BRANCH = 6


@pytest.fixture(scope="module")
def model(case: str) -> Case:
    return load_case(case)


@pytest.fixture(scope="module")
def run(service: Service) -> Run:
    run = service.call(service.registry.control.start("dam-break", 50.0))
    service.wait_for_status(run, RunStatus.FINISHED)
    return run


@pytest.fixture(scope="module")
def child(service: Service, run: Run) -> Run:
    """A branch at frame 6 with a levee."""
    revision = service.call(service.registry.edits.append(run.run, levee("l")))
    child = service.call(service.registry.branching.recalculate(run.run, BRANCH, revision))
    service.wait_for_status(child, RunStatus.FINISHED)
    return child


def channel(service: Service, run: Run, index: int, name: ChannelName) -> DecodedChannel:
    packed = service.call(service.registry.channels.read(run.run, index, name))
    grid = run.facts.grid
    return decode_channel(BlockLayout(grid.nrows, grid.ncols), unpack_channel(packed))


def offline(case: Case, index: int, levee_at: int | None = None) -> ShallowWaterSolver:
    """The solver alone at a frame."""
    solver = ShallowWaterSolver(case.model, case.params, "cpu")
    solver.set_water(case.initial_h)
    for k in range(index + 1):
        solver.advance_to(k * case.output_interval)
        if k == levee_at:
            solver.replace_bed(apply_edits(case.z_b, [levee("l")], case.grid).z_b)
    return solver


def assert_close(found: DecodedChannel, expected: dict[str, np.ndarray]) -> None:
    for name, values in expected.items():
        field = found.fields[name]
        np.testing.assert_array_equal(np.isinf(field), np.isinf(values))
        known = np.isfinite(values)
        np.testing.assert_allclose(field[known], values[known], rtol=1e-6, atol=found.error_bounds[name])


def maxima_of(solver: ShallowWaterSolver, depth_wet: float) -> dict[str, np.ndarray]:
    maxima = solver.maxima()
    came = np.isfinite(maxima.arrival_time)
    reached = came | (maxima.h >= depth_wet)
    return {
        "max_depth": np.where(reached, maxima.h, 0.0),
        "max_speed": np.where(reached, maxima.speed, 0.0),
        "max_hazard": np.where(reached, maxima.hazard, 0.0),
        "arrival_time": np.where(came, maxima.arrival_time, np.inf),
    }


@pytest.mark.parametrize("index", [0, 3, LAST])
def test_the_velocity_of_every_frame_is_that_of_the_solver(
    service: Service, run: Run, model: Case, index: int
) -> None:
    found = channel(service, run, index, "velocity")
    solver = offline(model, index)
    wet = solver.depth() >= model.params.depth_dry
    u, v = (np.where(wet, values, 0.0) for values in solver.velocity())
    assert (found.run, found.index, found.time) == (run.run, index, 5.0 * index)
    assert_close(found, {"u": u, "v": v})
    assert index == 0 or np.abs(v).max() > 1.0


@pytest.mark.parametrize(("asked", "sent"), [(0, 0), (3, 0), (4, 4), (7, 4), (9, 8), (LAST, LAST)])
def test_maxima_are_the_newest_at_or_before_the_frame(
    service: Service, run: Run, model: Case, asked: int, sent: int
) -> None:
    found = channel(service, run, asked, "maxima")
    assert (found.index, found.time) == (sent, 5.0 * sent)
    assert_close(found, maxima_of(offline(model, sent), model.params.depth_dry))


def test_a_branch_has_the_past_of_its_ancestor_and_maxima_that_include_it(
    service: Service, run: Run, child: Run, model: Case
) -> None:
    assert channel(service, child, BRANCH - 1, "velocity").run == run.run
    assert channel(service, child, BRANCH - 1, "maxima").index == 4
    for asked, sent in ((BRANCH, BRANCH), (7, BRANCH), (LAST, LAST)):
        found = channel(service, child, asked, "maxima")
        assert (found.run, found.index) == (child.run, sent)
    expected = maxima_of(offline(model, LAST, levee_at=BRANCH), model.params.depth_dry)
    assert_close(found, expected)
    without = maxima_of(offline(model, LAST), model.params.depth_dry)
    assert np.abs(expected["max_depth"] - without["max_depth"]).max() > 0.1


def test_a_run_keeps_what_it_is_asked_to_and_a_branch_what_its_parent_keeps(service: Service) -> None:
    some = service.call(service.registry.control.start("dam-break", 10.0, channels=("maxima",)))
    service.wait_for_status(some, RunStatus.FINISHED)
    assert service.registry.tree.info(some).channels == ("maxima",)
    with pytest.raises(RunError, match="keeps maxima, not velocity"):
        channel(service, some, 0, "velocity")
    child = service.call(service.registry.branching.recalculate(some.run, 1, 0))
    assert service.registry.tree.info(child).channels == ("maxima",)
    service.wait_for_status(child, RunStatus.FINISHED)
    assert channel(service, child, 2, "maxima").index == 2


def test_a_frame_that_is_not_there_has_no_channel(service: Service, run: Run) -> None:
    with pytest.raises(RunError, match=f"frame {LAST + 1} of run {run.run} is not computed yet"):
        channel(service, run, LAST + 1, "velocity")
    with pytest.raises(RunError, match="there is no run"):
        service.call(service.registry.channels.read("nobody", 0, "velocity"))


def test_a_case_without_gauges_and_sections_has_no_series(service: Service, run: Run) -> None:
    with pytest.raises(RunError, match="no gauge and no section"):
        service.call(service.registry.channels.series(run.run, 0))


def test_a_channel_that_was_forgotten_is_told(service: Service, run: Run) -> None:
    database = service.registry._store
    row = service.call(database.call(lambda rows: rows.newest_channel(run.run, 2, "velocity")))
    service.call(database.call(lambda rows: rows.delete_channel(row)))
    with pytest.raises(RunError, match=f"no velocity is kept with frame 2 of run {run.run}"):
        channel(service, run, 2, "velocity")


def test_a_damaged_channel_is_told(service: Service, run: Run) -> None:
    row = service.call(service.registry._store.call(lambda rows: rows.newest_channel(run.run, 5, "velocity")))
    path = service.registry._folder.frames(run.run) / row.segment
    content = bytearray(path.read_bytes())
    content[row.offset] ^= 1
    path.write_bytes(content)
    with pytest.raises(StoreError, match="channel velocity of frame 5"):
        channel(service, run, 5, "velocity")


@pytest.fixture
def plain_service(tmp_path: Path, case: str) -> Iterator[Service]:
    service = Service(tmp_path / "data", cases=(case,), threads=1, channels=("velocity",))
    yield service
    service.close()


def test_an_operator_may_switch_channels_off(plain_service: Service) -> None:
    run = plain_service.call(plain_service.registry.control.start("dam-break", 10.0))
    asked = plain_service.call(plain_service.registry.control.start("dam-break", 10.0, channels=("maxima",)))
    plain_service.wait_for_status(run, RunStatus.FINISHED)
    plain_service.wait_for_status(asked, RunStatus.FINISHED)
    assert plain_service.registry.tree.info(run).channels == ("velocity",)
    assert plain_service.registry.tree.info(asked).channels == ()
    with pytest.raises(RunError, match="keeps nothing beside the depth"):
        channel(plain_service, asked, 0, "maxima")
