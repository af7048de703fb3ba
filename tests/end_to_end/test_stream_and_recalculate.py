import itertools

import numpy as np
import pytest

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from protocol import BlockLayout, apply_edits
from solver_service.scenario import load_case
from tests.end_to_end.dam_break import CELLS, OUTPUT_INTERVAL, levee

LAST = 20
LAYOUT = BlockLayout(CELLS, CELLS)


def start(client: ServiceClient, case: str) -> str:
    return str(client.do(protocol.StartRun, case=case)["run"])


def finish(client: ServiceClient, run: str) -> protocol.RunInfo:
    """Wait until a run has ended."""
    while True:
        infos = {info.run: info for info in client.ask(protocol.ListRuns).runs}
        if infos[run].status == "finished":
            return infos[run]
        client.first(protocol.RunChanged)


def replay(client: ServiceClient, run: str, first: int = 0, last: int = LAST) -> list[protocol.DecodedFrame]:
    """Frames of a run in order, decoded."""
    client.do(protocol.Subscribe, run=run, from_index=first, mode="replay", credit=8)
    info = next(info for info in client.ask(protocol.ListRuns).runs if info.run == run)
    owners = [
        next(leg.run for leg in reversed(info.lineage) if leg.first_index <= index)
        for index in range(first, last + 1)
    ]
    wanted = list(zip(owners, range(first, last + 1), strict=True))
    while not all(name in client.decoded for name in wanted):
        client.first(protocol.Frame)
    client.do(protocol.Unsubscribe)
    return [client.decoded[name] for name in wanted]


def recalculate(client: ServiceClient, run: str, index: int, **options: bool) -> str:
    log = next(info for info in client.ask(protocol.ListRuns).runs if info.run == run)
    answer = client.do(protocol.Recalculate, run=run, index=index, revision=log.revision, **options)
    return str(answer["run"])


@pytest.fixture(scope="module")
def flood(service: ServiceProcess, case: str) -> tuple[str, list[protocol.DecodedFrame]]:
    """A run that nobody edited, to its end."""
    with ServiceClient(service, layout=LAYOUT) as client:
        run = start(client, case)
        finish(client, run)
        return run, replay(client, run)


def test_every_frame_comes_in_order_at_its_time_with_the_water_of_the_case(
    flood: tuple[str, list[protocol.DecodedFrame]], case: str
) -> None:
    _, frames = flood
    assert [frame.index for frame in frames] == list(range(LAST + 1))
    assert [frame.time for frame in frames] == [OUTPUT_INTERVAL * index for index in range(LAST + 1)]
    initial = load_case(case).initial_h
    scale = frames[0].scale
    np.testing.assert_allclose(frames[0].h, initial, atol=max(0.5 * scale, 1.1e-3))
    assert (frames[-1].h > 0.01).sum() > 2 * (initial > 0.01).sum()


def test_the_terrain_is_the_bed_of_the_solver_bit_for_bit(
    client: ServiceClient, flood: tuple[str, list[protocol.DecodedFrame]], case: str
) -> None:
    client.do(protocol.GetTerrain, run=flood[0])
    terrain = client.first(protocol.TerrainReceived)
    np.testing.assert_array_equal(terrain.z_b, load_case(case).z_b)


def test_a_recalculation_begins_at_the_frame_itself_on_the_edited_bed(
    client: ServiceClient, case: str
) -> None:
    run = start(client, case)
    client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=4)
    client.frame(run, 6)
    edit = levee("dike", y=250.0)
    revision = client.do(protocol.AppendEdit, run=run, edit=edit)["revision"]
    assert revision == 1
    command = protocol.Recalculate(id=client.session.next_id(), run=run, index=5, revision=1)
    client.send(command)
    ack = client.first(protocol.Ack, lambda answer: answer.id == command.id)
    child = ack.result["run"]
    changed = client.first(protocol.RunChanged, lambda event: event.run.run == child)
    assert (changed.run.parent, changed.run.branch_index, changed.run.revision) == (run, 5, 1)
    frame = client.first(protocol.Frame, lambda frame: frame.run == child)
    assert (frame.index, frame.time, frame.revision, frame.is_key) == (5, 25.0, 1, True)

    edited = client.decoded[child, 5]
    (before,) = replay(client, run, 5, 5)
    raised = apply_edits(load_case(case).z_b, [edit], load_case(case).grid).z_b - load_case(case).z_b
    expected = np.maximum(before.h - raised, 0.0)
    np.testing.assert_allclose(edited.h, expected, atol=edited.scale + 1e-3)
    assert np.count_nonzero((before.h > 0.5) & (raised > 0)) > 20


def test_the_parent_waits_and_can_be_resumed_to_the_very_frames_it_would_have_had(
    client: ServiceClient, case: str, flood: tuple[str, list[protocol.DecodedFrame]]
) -> None:
    run = start(client, case)
    client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=4)
    client.frame(run, 4)
    client.do(protocol.AppendEdit, run=run, edit=levee("dike"))
    child = recalculate(client, run, 3)
    statuses = {info.run: info.status for info in client.ask(protocol.ListRuns).runs}
    if statuses[run] != "finished":
        assert statuses[run] == "paused"
        answer = client.ask(protocol.ResumeRun, run=run)  # its last frame may come meanwhile
        assert isinstance(answer, protocol.Ack) or "is finished" in answer.message
    finish(client, run)
    finish(client, child)
    for frame, undisturbed in zip(replay(client, run), flood[1], strict=True):
        np.testing.assert_array_equal(frame.q, undisturbed.q)
    assert any((a.q != b.q).any() for a, b in zip(replay(client, child, 3), flood[1][3:], strict=True))


def test_an_edit_taken_back_and_recalculated_at_the_same_frame_leaves_no_trace(
    client: ServiceClient, case: str, flood: tuple[str, list[protocol.DecodedFrame]]
) -> None:
    run, frames = flood
    client.do(protocol.AppendEdit, run=run, edit=levee("dike", y=200.0))
    child = recalculate(client, run, 7)
    assert (replay(client, child, 7, 7)[0].q != frames[7].q).any()
    revision = next(info.revision for info in client.ask(protocol.ListRuns).runs if info.run == child)
    assert client.do(protocol.UndoEdit, run=child)["revision"] == revision + 1
    grandchild = recalculate(client, child, 7)
    client.do(protocol.UndoEdit, run=run)
    finish(client, grandchild)
    for frame, undisturbed in zip(replay(client, grandchild, 7), frames[7:], strict=True):
        np.testing.assert_array_equal(frame.q, undisturbed.q)


def test_frames_before_the_branch_are_those_of_the_ancestors(
    client: ServiceClient, flood: tuple[str, list[protocol.DecodedFrame]]
) -> None:
    run, frames = flood
    client.do(protocol.AppendEdit, run=run, edit=levee("a", y=400.0))
    child = recalculate(client, run, 4)
    client.do(protocol.UndoEdit, run=run)
    finish(client, child)
    client.do(protocol.AppendEdit, run=child, edit=levee("b", y=500.0))
    grandchild = recalculate(client, child, 9)
    info = finish(client, grandchild)
    assert [(leg.run, leg.first_index) for leg in info.lineage] == [(run, 0), (child, 4), (grandchild, 9)]
    seen = replay(client, grandchild)
    owners = [frame.run for frame in seen]
    assert owners == [run] * 4 + [child] * 5 + [grandchild] * (LAST - 8)
    for frame, original in zip(seen[:4], frames, strict=False):
        np.testing.assert_array_equal(frame.q, original.q)


def test_a_run_that_is_kept_goes_on_beside_its_child(client: ServiceClient, case: str) -> None:
    run = start(client, case)
    client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=4)
    client.frame(run, 3)
    client.do(protocol.AppendEdit, run=run, edit=levee("dike"))
    child = recalculate(client, run, 2, keep_parent=True)
    statuses = {info.run: info.status for info in client.ask(protocol.ListRuns).runs}
    assert statuses[run] in ("running", "finished")
    assert finish(client, run).frame_count == LAST + 1
    assert finish(client, child).frame_count == LAST + 1


def test_what_cannot_be_recalculated_is_refused_in_a_sentence_and_changes_nothing(
    client: ServiceClient, flood: tuple[str, list[protocol.DecodedFrame]]
) -> None:
    run, _ = flood
    before = client.ask(protocol.ListRuns).runs
    revision = next(info.revision for info in before if info.run == run)
    beyond = client.ask(protocol.Recalculate, run=run, index=LAST + 1, revision=revision)
    assert "not computed yet" in beyond.message
    stale = client.ask(protocol.Recalculate, run=run, index=3, revision=revision + 1)
    assert f"at revision {revision}" in stale.message
    outside = client.ask(protocol.AppendEdit, run=run, edit=levee("far", y=5000.0))
    assert outside.code == "invalid_edit"
    nobody = client.ask(protocol.PauseRun, run="r000")
    assert "there is no run" in nobody.message
    ended = client.ask(protocol.PauseRun, run=run)
    assert "finished and cannot be paused" in ended.message
    unknown = client.ask(protocol.StartRun, case="../../etc")
    assert "there is no case" in unknown.message
    assert client.ask(protocol.ListRuns).runs == before


def test_a_device_that_is_absent_is_refused_and_no_run_is_made(client: ServiceClient, case: str) -> None:
    before = len(client.ask(protocol.ListRuns).runs)
    answer = client.ask(protocol.StartRun, case=case, device="cuda:63")
    assert "cuda:63" in answer.message
    assert len(client.ask(protocol.ListRuns).runs) == before


def test_other_viewers_are_told_of_the_branch_and_stay(
    service: ServiceProcess, client: ServiceClient, flood: tuple[str, list[protocol.DecodedFrame]]
) -> None:
    run, _ = flood
    with ServiceClient(service) as other:
        other.do(protocol.Subscribe, run=run, from_index=LAST, mode="replay", credit=8)
        other.frame(run, LAST)
        client.do(protocol.Subscribe, run=run, from_index=LAST, mode="replay", credit=8)
        client.do(protocol.AppendEdit, run=run, edit=levee("dike"))
        told = other.first(protocol.EditsChanged, lambda event: event.run == run and len(event.edits) == 1)
        child = recalculate(client, run, LAST - 2)
        branched = other.first(protocol.RunBranched)
        assert (branched.parent, branched.child.run) == (run, child)
        assert client.first(protocol.Frame, lambda frame: frame.run == child).index == LAST - 2
        other.do(protocol.Seek, run=run, index=3)
        assert other.frame(run, 3).run == run
        assert told.can_undo
    client.do(protocol.UndoEdit, run=run)


def test_edits_undo_and_redo_make_one_history_of_revisions(client: ServiceClient, case: str) -> None:
    run = str(client.do(protocol.StartRun, case=case, paused=True)["run"])
    client.do(protocol.Subscribe, run=run)
    commands = [
        (protocol.AppendEdit, {"edit": levee("a")}, ["a"], (True, False)),
        (protocol.AppendEdit, {"edit": levee("b")}, ["a", "b"], (True, False)),
        (protocol.UndoEdit, {}, ["a"], (True, True)),
        (protocol.RedoEdit, {}, ["a", "b"], (True, False)),
        (protocol.UndoEdit, {}, ["a"], (True, True)),
        (protocol.AppendEdit, {"edit": levee("c")}, ["a", "c"], (True, False)),
    ]
    for revision, (kind, fields, names, can) in enumerate(commands, start=1):
        assert client.do(kind, run=run, **fields)["revision"] == revision
        event = client.first(protocol.EditsChanged, lambda event: event.revision > 0)
        assert (event.revision, [edit.id for edit in event.edits]) == (revision, names)
        assert (event.can_undo, event.can_redo) == can
    assert "no edit to redo" in client.ask(protocol.RedoEdit, run=run).message


def test_a_run_that_starts_paused_has_its_first_frame_and_waits(client: ServiceClient, case: str) -> None:
    run = str(client.do(protocol.StartRun, case=case, paused=True)["run"])
    client.do(protocol.Subscribe, run=run)
    client.frame(run, 0)
    client.first(protocol.RunChanged, lambda event: event.run.run == run and event.run.status == "paused")
    client.do(protocol.ResumeRun, run=run)
    assert client.frame(run, LAST).time == OUTPUT_INTERVAL * LAST
    assert finish(client, run).frame_count == LAST + 1
    client.do(protocol.StartRun, case=case, duration=12.0, output_interval=5.0)
    short = client.ask(protocol.ListRuns).runs[0]
    assert finish(client, short.run).frame_count == 4
    assert "cannot be resumed" in client.ask(protocol.ResumeRun, run=short.run).message


def test_a_stopped_run_keeps_its_frames_and_is_never_resumed(client: ServiceClient, case: str) -> None:
    run = str(client.do(protocol.StartRun, case=case, paused=True)["run"])
    client.do(protocol.Subscribe, run=run)
    client.frame(run, 0)
    client.do(protocol.StopRun, run=run)
    assert "stopped and cannot be resumed" in client.ask(protocol.ResumeRun, run=run).message
    assert replay(client, run, 0, 0)[0].index == 0


def test_revisions_of_frames_tell_the_bed_they_were_computed_on(
    client: ServiceClient, flood: tuple[str, list[protocol.DecodedFrame]]
) -> None:
    assert {frame.revision for frame in flood[1]} == {0}
    for before, after in itertools.pairwise(flood[1]):
        assert (before.q != after.q).any()
