"""Two people at one run: who controls it, and one order of what they do."""

import random
import threading
import time
from dataclasses import replace

import pytest

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from protocol import ResumePoint
from tests.end_to_end.dam_break import levee
from tests.end_to_end.history import Change, check_history

COMMANDS = 60


def start_paused(client: ServiceClient, case: str) -> str:
    run = str(client.do(protocol.StartRun, case=case, paused=True)["run"])
    client.do(protocol.Subscribe, run=run)
    return run


def session_of(client: ServiceClient) -> str:
    assert client.session.welcome is not None
    return client.session.welcome.session


def test_a_follower_is_refused_until_control_is_handed_over(
    service: ServiceProcess, client: ServiceClient, case: str
) -> None:
    run = start_paused(client, case)
    with ServiceClient(service) as follower:
        follower.do(protocol.Subscribe, run=run)
        told = follower.first(protocol.ControlChanged)
        assert (told.run, told.session) == (run, session_of(client))
        refused = follower.ask(protocol.AppendEdit, run=run, edit=levee("a"))
        assert f"controlled by session {session_of(client)}" in refused.message
        asked: list[tuple[type[protocol.Command], dict[str, object]]] = [
            (protocol.AppendEdits, {"edits": (levee("a"), levee("b"))}),
            (protocol.ReplaceEdit, {"edit": levee("a")}),
            (protocol.DeleteEdit, {"edit": "a"}),
        ]
        for kind, fields in asked:
            assert "controlled by session" in follower.ask(kind, run=run, **fields).message
        refused = follower.ask(protocol.ChangeForcing, run=run, changes=())
        assert f"controlled by session {session_of(client)}" in refused.message
        assert "active" in follower.ask(protocol.TakeControl, run=run).message
        assert client.first(protocol.ControlRequested).session == session_of(follower)
        client.do(protocol.ReleaseControl, run=run, to=session_of(follower))
        assert follower.first(protocol.ControlChanged).session == session_of(follower)
        assert follower.do(protocol.AppendEdit, run=run, edit=levee("a"))["revision"] == 1
        assert "controlled by session" in client.ask(protocol.UndoEdit, run=run).message
        client.do(protocol.TakeControl, run=run, force=True)
        assert follower.first(protocol.ControlChanged).session == session_of(client)
        assert client.do(protocol.UndoEdit, run=run)["revision"] == 2


def test_control_ends_with_the_connection_and_passes_to_the_one_that_replaces_it(
    service: ServiceProcess, client: ServiceClient, case: str
) -> None:
    with ServiceClient(service) as gone:
        run = start_paused(gone, case)
        client.do(protocol.Subscribe, run=run)
        assert client.first(protocol.ControlChanged).session == session_of(gone)
        resume = ResumePoint(run, -1, 0, session_of(gone))
        with ServiceClient(service, resume=resume) as again:
            assert client.first(protocol.ControlChanged).session == session_of(again)
            assert again.do(protocol.AppendEdit, run=run, edit=levee("a"))["revision"] == 1
    assert client.first(protocol.ControlChanged, lambda event: event.session is None).run == run
    assert client.do(protocol.UndoEdit, run=run)["revision"] == 2


def test_two_people_who_take_control_from_each_other_make_one_history(
    service: ServiceProcess, client: ServiceClient, case: str
) -> None:
    run = start_paused(client, case)
    client.do(protocol.ReleaseControl, run=run)
    changes: list[Change] = []
    threads = [threading.Thread(target=change_at_random, args=(service, run, name, changes)) for name in "ab"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    client.do(protocol.Subscribe, run=run)
    final = client.first(protocol.EditsChanged, lambda event: event.revision == len(changes))
    names = tuple(edit.id for edit in final.edits)
    assert len(changes) > COMMANDS // 2
    check_history(changes, names)
    with pytest.raises(AssertionError, match="revisions have gaps"):
        check_history(changes[1:], names)
    last = max(changes, key=lambda change: change.revision)
    with pytest.raises(AssertionError, match="was asked for after"):
        check_history(
            [change for change in changes if change is not last] + [moved_before(last, changes)], ()
        )


def moved_before(last: Change, changes: list[Change]) -> Change:
    """The last change as if it had been answered before the first one was sent."""
    first = min(change.sent_at for change in changes)
    return replace(last, sent_at=first - 2.0, answered_at=first - 1.0)


def change_at_random(service: ServiceProcess, run: str, name: str, changes: list[Change]) -> None:
    chance = random.Random(name)
    kinds = {"append": protocol.AppendEdit, "undo": protocol.UndoEdit, "redo": protocol.RedoEdit}
    with ServiceClient(service) as client:
        for number in range(COMMANDS):
            kind = chance.choice(("append", "append", "undo", "redo"))
            edit = levee(f"{name}{number}") if kind == "append" else None
            fields = {"edit": edit} if edit is not None else {}
            sent_at = time.monotonic()
            answer = client.ask(kinds[kind], run=run, **fields)
            if isinstance(answer, protocol.Ack):
                revision = int(answer.result["revision"] or 0)
                changes.append(Change(kind, edit, revision, sent_at, time.monotonic()))
            elif "controlled by" in answer.message:
                client.do(protocol.TakeControl, run=run, force=True)
