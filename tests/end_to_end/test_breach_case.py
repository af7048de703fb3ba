"""A levee that breaks, with nearly everything a case may hold: the service gives the frames of the solver."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from protocol import BlockLayout, EditLine, EditType, Operation, apply_edits
from solver_service.numerics import ShallowWaterSolver
from solver_service.scenario import Case, load_case

FOLDER = str(Path(__file__).parents[2] / "examples" / "levee_breach")
LAST = 20
BEFORE, AFTER = 3, 9
"""Frames at which is branched: the levee breaks at frame 5."""
DIKE = EditLine(
    id="dike",
    vertices=((150.0, 190.0), (290.0, 210.0)),
    width=20.0,
    operation=Operation.raise_,
    type=EditType.modulate,
    magnitude=1.5,
)


@pytest.fixture(scope="module")
def levee_case() -> Case:
    return load_case(FOLDER)


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServiceProcess]:
    with ServiceProcess(tmp_path_factory.mktemp("data"), cases=[FOLDER], threads=1) as service:
        yield service


@pytest.fixture
def client(service: ServiceProcess, levee_case: Case) -> Iterator[ServiceClient]:
    layout = BlockLayout(levee_case.grid.nrows, levee_case.grid.ncols)
    with ServiceClient(service, layout=layout) as client:
        yield client


def offline(
    case: Case, edit_at: int | None = None
) -> tuple[Callable[[int, float], np.ndarray], list[np.ndarray]]:
    """Quantised water and bed of each output time of a run from scratch; the dike is drawn at a frame."""
    solver = ShallowWaterSolver(case.model, case.params, "cpu")
    solver.set_water(case.initial_h)
    depths, beds = [], []
    for index in range(LAST + 1):
        solver.advance_to(index * case.output_interval)
        if index == edit_at:
            solver.replace_bed(apply_edits(case.z_b, [DIKE], case.grid).z_b)
        depths.append(solver.depth())
        beds.append(solver.bed)
    return lambda index, scale: protocol.quantise_depth(depths[index], scale, case.params.depth_dry), beds


Flood = tuple[Callable[[int, float], np.ndarray], list[np.ndarray]]


@pytest.fixture(scope="module")
def bare_flood(levee_case: Case) -> Flood:
    """Nobody draws anything."""
    return offline(levee_case)


@pytest.fixture(scope="module")
def run(service: ServiceProcess) -> str:
    """A run of the service to its end."""
    with ServiceClient(service) as client:
        run = str(client.do(protocol.StartRun, case=FOLDER)["run"])
        finish(client, run)
        return run


def shown_bed(case: Case, edits: list[EditLine], frame: protocol.DecodedFrame) -> np.ndarray:
    """The ground as a viewer knows it: base, edits, and what the frame says that breaches have lowered."""
    bed = apply_edits(case.z_b, edits, case.grid).z_b.copy()
    bed.flat[frame.bed_cells] = frame.bed_values
    return bed


def finish(client: ServiceClient, run: str) -> None:
    while {info.run: info.status for info in client.ask(protocol.ListRuns).runs}[run] != "finished":
        client.first(protocol.RunChanged)


def frames(client: ServiceClient, run: str, first: int) -> list[protocol.DecodedFrame]:
    client.do(protocol.Subscribe, run=run, from_index=first, mode="replay", credit=8)
    while (run, LAST) not in client.decoded:
        client.first(protocol.Frame)
    client.do(protocol.Unsubscribe)
    return [client.decoded[run, index] for index in range(first, LAST + 1)]


def test_every_frame_is_that_of_the_solver_alone_bit_for_bit(
    client: ServiceClient, levee_case: Case, run: str, bare_flood: Flood
) -> None:
    expected, beds = bare_flood
    lowered = []
    for frame in frames(client, run, 0):
        np.testing.assert_array_equal(frame.q, expected(frame.index, frame.scale))
        np.testing.assert_array_equal(shown_bed(levee_case, [], frame), beds[frame.index])
        lowered.append(frame.bed_cells.size)
    assert lowered[:5] == [0] * 5
    assert lowered[-1] > 5


def series(client: ServiceClient, run: str, from_index: int = 0) -> protocol.DecodedSeries:
    answer = client.do(protocol.GetSeries, run=run, from_index=from_index)
    received = client.first(protocol.SeriesReceived).series
    assert answer["index"] == received.index
    return protocol.decode_series(received)


def test_gauges_and_sections_come_at_full_rate_in_stretches_over_a_branch_too(
    client: ServiceClient, levee_case: Case, run: str
) -> None:
    revision = client.do(protocol.AppendEdit, run=run, edit=DIKE)["revision"]
    child = str(client.do(protocol.Recalculate, run=run, index=BEFORE, revision=revision)["run"])
    client.do(protocol.UndoEdit, run=run)
    finish(client, child)
    for name, edit_at in ((run, None), (child, BEFORE)):
        solver = ShallowWaterSolver(levee_case.model, levee_case.params, "cpu")
        solver.set_water(levee_case.initial_h)
        for index in range(LAST + 1):
            solver.advance_to(index * levee_case.output_interval)
            if index == edit_at:
                solver.replace_bed(apply_edits(levee_case.z_b, [DIKE], levee_case.grid).z_b)
        expected, passed = solver.gauge_series(), solver.section_series()
        whole, tail = series(client, name), series(client, name, AFTER)
        assert (whole.run, whole.index) == (name, LAST)
        np.testing.assert_array_equal(whole.times, expected.times)
        np.testing.assert_array_equal(whole.gauge_values[..., 0], expected.h)
        np.testing.assert_array_equal(
            whole.section_values[..., 0], passed.discharge[:, : len(whole.sections)]
        )
        later = expected.times > (AFTER - 1) * levee_case.output_interval
        np.testing.assert_array_equal(tail.times, expected.times[later])
        np.testing.assert_array_equal(tail.gauge_values[..., 0], expected.h[later])
    assert len(expected.times) > 2 * LAST, "more often than frames"
    assert whole.gauges == tuple(gauge.id for gauge in levee_case.gauges)


def test_whoever_watches_is_told_where_gauges_and_sections_are(client: ServiceClient, run: str) -> None:
    client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=1)
    places = client.first(protocol.Places)

    assert places.run == run
    assert [(gauge.id, gauge.x, gauge.y) for gauge in places.gauges] == [
        ("town", 305.0, 205.0),
        ("river", 45.0, 205.0),
    ]
    assert places.sections[0].line == ((230.0, 0.0), (230.0, 400.0))


def test_series_of_frames_that_are_not_computed_yet_are_refused(client: ServiceClient, run: str) -> None:
    with pytest.raises(RuntimeError, match=f"frame {LAST + 1} of run {run} is not computed yet"):
        client.do(protocol.GetSeries, run=run, from_index=LAST + 1)


@pytest.mark.parametrize("channel", ["velocity", "maxima"])
def test_channels_come_over_the_wire_as_they_are_asked_for(
    client: ServiceClient, levee_case: Case, run: str, channel: protocol.ChannelName
) -> None:
    client.do(protocol.GetChannel, run=run, index=AFTER, channel=channel)
    received = client.first(protocol.ChannelReceived).channel
    decoded = protocol.decode_channel(BlockLayout(*levee_case.grid.shape), received)
    assert decoded.channel == channel
    assert tuple(decoded.fields) == protocol.CHANNEL_FIELDS[channel]
    assert max(np.abs(field[np.isfinite(field)]).max() for field in decoded.fields.values()) > 0.5


@pytest.mark.parametrize("index", [BEFORE, AFTER])
def test_a_branch_before_or_in_the_breach_is_a_run_from_scratch_with_the_edit_then_and_undone_is_the_parent(
    client: ServiceClient, levee_case: Case, run: str, bare_flood: Flood, index: int
) -> None:
    revision = client.do(protocol.AppendEdit, run=run, edit=DIKE)["revision"]
    child = str(client.do(protocol.Recalculate, run=run, index=index, revision=revision)["run"])
    finish(client, child)
    (expected, beds), (unedited, bare) = offline(levee_case, index), bare_flood
    branch = frames(client, child, index)
    for frame in branch:
        np.testing.assert_array_equal(frame.q, expected(frame.index, frame.scale))
        np.testing.assert_array_equal(shown_bed(levee_case, [DIKE], frame), beds[frame.index])
    assert (branch[-1].q != unedited(LAST, branch[-1].scale)).any()

    revision = client.do(protocol.UndoEdit, run=run)["revision"]
    undone = str(client.do(protocol.Recalculate, run=run, index=index, revision=revision)["run"])
    finish(client, undone)
    for frame in frames(client, undone, index):
        np.testing.assert_array_equal(frame.q, unedited(frame.index, frame.scale))
        np.testing.assert_array_equal(shown_bed(levee_case, [], frame), bare[frame.index])
