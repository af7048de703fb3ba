"""Commands in any order against the real service: what the one table of moves says is what happens."""

from typing import Any

import hypothesis.strategies as st
import pytest
from hypothesis import HealthCheck, settings
from hypothesis.stateful import (
    RuleBasedStateMachine,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from solver_service.runs.run_status import RULES, Move, RunStatus
from tests.end_to_end.dam_break import OUTPUT_INTERVAL, levee

MOVES = {
    protocol.PauseRun: Move.PAUSE,
    protocol.ResumeRun: Move.RESUME,
    protocol.StopRun: Move.STOP,
    protocol.DeleteRun: Move.DELETE,
    protocol.PinRun: Move.PIN,
    protocol.UnpinRun: Move.UNPIN,
}
PICK = st.integers(0, 1000)


class Session(RuleBasedStateMachine):
    """The runs that one client made, as it must believe them to be."""

    service: ServiceProcess
    case: str

    def __init__(self) -> None:
        super().__init__()
        self.client = ServiceClient(self.service).__enter__()
        self.labels: dict[str, str] = {}
        self.runs: list[str] = []
        self.edits: dict[str, list[str]] = {}
        self.done: dict[str, list[list[str]]] = {}
        self.undone: dict[str, list[list[str]]] = {}
        self.revision: dict[str, int] = {}
        self.forcing: dict[str, protocol.ForcingChanged] = {}
        self.pinned: set[str] = set()
        self.parent: dict[str, str] = {}
        self.numbers = 0

    def infos(self) -> dict[str, protocol.RunInfo]:
        return {info.run: info for info in self.client.ask(protocol.ListRuns).runs}

    def pick(self, number: int) -> str:
        return self.runs[number % len(self.runs)]

    def know(self, run: str, like: str | None = None) -> None:
        self.runs.append(run)
        self.edits[run] = list(self.edits.get(like or "", []))
        self.done[run] = list(self.done.get(like or "", []))
        self.undone[run] = list(self.undone.get(like or "", []))
        self.revision[run] = self.revision.get(like or "", 0)
        like_it = self.forcing.get(like or "", protocol.ForcingChanged("", 0, ()))
        self.forcing[run] = protocol.ForcingChanged(run, like_it.revision, like_it.changes, like_it.changes)

    @precondition(lambda self: len(self.runs) < 4)
    @rule(paused=st.booleans())
    def start(self, paused: bool) -> None:
        self.know(
            str(self.client.do(protocol.StartRun, case=self.case, duration=200.0, paused=paused)["run"])
        )

    @precondition(lambda self: self.runs)
    @rule(number=PICK, kind=st.sampled_from(sorted(MOVES, key=lambda kind: kind.__name__)))
    def move(self, number: int, kind: type[protocol.Command]) -> None:
        run = self.pick(number)
        before = RunStatus(self.infos()[run].status)
        answer = self.client.ask(kind, run=run)
        after = self.infos().get(run)
        move = MOVES[kind]
        seen = {before} | ({RunStatus(after.status)} if after is not None else set())
        needed = kind is protocol.DeleteRun and (run in self.pinned or run in self.parent.values())
        if isinstance(answer, protocol.Ack):
            # the worker may have moved the run on its own between the two looks
            assert not needed
            assert {before, *later(before)} & RULES[move].sources
        else:
            assert needed or (seen | later(before)) - RULES[move].sources, answer.message
            assert "cannot be" in answer.message
        if isinstance(answer, protocol.Ack) and kind is protocol.DeleteRun:
            assert after is None
            self.runs.remove(run)
            self.parent.pop(run, None)
        elif isinstance(answer, protocol.Ack) and kind is protocol.StopRun:
            assert after is not None
            assert after.status == "stopped"
        elif kind is protocol.PinRun:
            self.pinned.add(run)
        elif kind is protocol.UnpinRun:
            self.pinned.discard(run)

    @precondition(lambda self: self.runs)
    @rule(number=PICK, count=st.integers(1, 3))
    def append(self, number: int, count: int) -> None:
        run = self.pick(number)
        names = [f"e{self.numbers + n}" for n in range(count)]
        self.numbers += count
        edits = tuple(levee(name) for name in names)
        if count == 1:
            answer = self.client.do(protocol.AppendEdit, run=run, edit=edits[0])
        else:
            answer = self.client.do(protocol.AppendEdits, run=run, edits=edits)
        self.change(run, [*self.edits[run], *names], answer["revision"])

    @precondition(lambda self: self.runs)
    @rule(number=PICK, which=PICK)
    def delete(self, number: int, which: int) -> None:
        run = self.pick(number)
        names = [*self.edits[run], "never"]
        name = names[which % len(names)]
        answer = self.client.ask(protocol.DeleteEdit, run=run, edit=name)
        if name == "never":
            assert "is not in the list" in answer.message
        else:
            left = [other for other in self.edits[run] if other != name]
            self.change(run, left, answer.result["revision"])

    @precondition(lambda self: self.runs)
    @rule(number=PICK, which=PICK)
    def replace(self, number: int, which: int) -> None:
        run = self.pick(number)
        names = [*self.edits[run], "never"]
        name = names[which % len(names)]
        answer = self.client.ask(protocol.ReplaceEdit, run=run, edit=levee(name, height=2.0))
        if name == "never":
            assert "is not in the list" in answer.message
        else:
            self.change(run, self.edits[run], answer.result["revision"])

    @precondition(lambda self: self.runs)
    @rule(number=PICK)
    def undo(self, number: int) -> None:
        run = self.pick(number)
        answer = self.client.ask(protocol.UndoEdit, run=run)
        if self.done[run]:
            self.undone[run].append(self.edits[run])
            self.edits[run] = self.done[run].pop()
            self.changed(run, answer.result["revision"])
        else:
            assert "no edit to undo" in answer.message

    @precondition(lambda self: self.runs)
    @rule(number=PICK)
    def redo(self, number: int) -> None:
        run = self.pick(number)
        answer = self.client.ask(protocol.RedoEdit, run=run)
        if self.undone[run]:
            self.done[run].append(self.edits[run])
            self.edits[run] = self.undone[run].pop()
            self.changed(run, answer.result["revision"])
        else:
            assert "no edit to redo" in answer.message

    @precondition(lambda self: self.runs)
    @rule(number=PICK, rate=st.integers(0, 3), item=st.sampled_from(["rain", "rain", "never"]))
    def force(self, number: int, rate: int, item: str) -> None:
        run = self.pick(number)
        falls = protocol.ForcingSeries((0.0,), (float(rate),))
        changes = (protocol.ForcingChange(item, series=falls),) if rate else ()
        answer = self.client.ask(protocol.ChangeForcing, run=run, changes=changes)
        if rate and item == "never":
            assert "has no forcing 'never'" in answer.message
            return
        held = self.forcing[run]
        assert answer.result["revision"] == held.revision + 1
        self.forcing[run] = protocol.ForcingChanged(run, held.revision + 1, changes, held.applied)

    @precondition(lambda self: 0 < len(self.runs) < 4)
    @rule(number=PICK, index=st.integers(0, 12), stale=st.booleans(), ahead=st.sampled_from([None, 0, 1]))
    def recalculate(self, number: int, index: int, stale: bool, ahead: int | None) -> None:
        run = self.pick(number)
        count = self.infos()[run].frame_count
        revision = self.revision[run] + stale
        forcing = None if ahead is None else self.forcing[run].revision + ahead
        answer = self.client.ask(
            protocol.Recalculate, run=run, index=index, revision=revision, forcing_revision=forcing
        )
        if isinstance(answer, protocol.Ack):
            assert not stale
            assert not ahead
            child = str(answer.result["run"])
            self.know(child, like=run)
            info = self.infos()[child]
            assert info.branch_index == index
            assert info.parent is not None
            self.parent[child] = info.parent
        elif "is not computed yet" in answer.message:
            assert index >= count
        else:
            assert stale or ahead, answer.message
            assert ("are at revision" if stale else "forcing of run") in answer.message

    def change(self, run: str, names: list[str], revision: Any) -> None:
        self.done[run].append(self.edits[run])
        self.undone[run] = []
        self.edits[run] = names
        self.changed(run, revision)

    def changed(self, run: str, revision: Any) -> None:
        self.revision[run] += 1
        assert revision == self.revision[run]

    @precondition(lambda self: self.runs)
    @rule(number=PICK, label=st.sampled_from(("", "north dike", "\u6c34")))
    def rename(self, number: int, label: str) -> None:
        run = self.pick(number)
        self.client.do(protocol.RenameRun, run=run, label=label)
        self.labels[run] = label

    @precondition(lambda self: self.runs)
    @rule(number=PICK, index=st.integers(0, 12))
    def seek(self, number: int, index: int) -> None:
        run = self.pick(number)
        info = self.infos()[run]
        if index < info.frame_count:
            owners = [leg.run for leg in info.lineage if leg.first_index <= index]
            self.client.do(protocol.Subscribe, run=run, from_index=index, mode="replay", credit=2)
            frame = self.client.first(protocol.Frame, lambda frame: frame.index == index)
            assert (frame.run, frame.time) == (owners[-1], OUTPUT_INTERVAL * index)
            self.client.do(protocol.Unsubscribe)

    @precondition(lambda self: self.runs)
    @rule(number=PICK, is_cut=st.booleans())
    def reconnect(self, number: int, is_cut: bool) -> None:
        lost = self.client
        resume = protocol.ResumePoint(self.pick(number), -1, 0, session_of(lost))
        if is_cut:
            lost.cut()
        self.client = ServiceClient(self.service, resume=resume).__enter__()
        lost.__exit__(None, None, None)

    @precondition(lambda self: self.runs)
    @rule(number=PICK, hands_back=st.booleans())
    def be_overruled(self, number: int, hands_back: bool) -> None:
        run = self.pick(number)
        with ServiceClient(self.service) as rival:
            rival.do(protocol.TakeControl, run=run, force=True)
            refused = self.client.ask(protocol.AppendEdit, run=run, edit=levee("refused"))
            assert f"controlled by session {session_of(rival)}" in refused.message
            if hands_back:
                rival.do(protocol.ReleaseControl, run=run, to=session_of(self.client))
        if not hands_back:
            self.client.do(protocol.TakeControl, run=run, force=True)

    @invariant()
    def the_service_says_what_the_model_says(self) -> None:
        infos = self.infos()
        for run in self.runs:
            assert infos[run].revision == self.revision[run]
            assert infos[run].forcing_revision == self.forcing[run].revision
            assert infos[run].pinned == (run in self.pinned)
            assert infos[run].label == self.labels.get(run, "")

    def teardown(self) -> None:
        for run in self.runs:
            self.client.do(protocol.Subscribe, run=run)
            told = self.client.first(protocol.EditsChanged, lambda event, run=run: event.run == run)
            if told.revision == self.revision[run]:
                assert [edit.id for edit in told.edits] == self.edits[run]
            forced = self.client.first(protocol.ForcingChanged, lambda event, run=run: event.run == run)
            held = self.forcing[run]
            assert (forced.changes, forced.applied) == (held.changes, held.applied)
        for run in reversed(self.runs):
            self.client.ask(protocol.StopRun, run=run)
        self.client.__exit__(None, None, None)


def session_of(client: ServiceClient) -> str:
    assert client.session.welcome is not None
    return client.session.welcome.session


def later(status: RunStatus) -> set[RunStatus]:
    """What a run may become by itself."""
    if status is RunStatus.STARTING:
        return {RunStatus.RUNNING, RunStatus.PAUSED, RunStatus.FINISHED}
    return {RunStatus.PAUSED, RunStatus.FINISHED} if status is RunStatus.RUNNING else {RunStatus.FINISHED}


@pytest.mark.slow
def test_any_order_of_commands_does_what_the_table_of_moves_says(service: ServiceProcess, case: str) -> None:
    class Model(Session):
        pass

    Model.service, Model.case = service, case
    run_state_machine_as_test(
        Model,
        settings=settings(
            max_examples=5,
            stateful_step_count=15,
            deadline=None,
            suppress_health_check=list(HealthCheck),
            database=None,
        ),
    )
