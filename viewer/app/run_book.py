"""What the service has said about cases, runs, their edits and their progress."""

from __future__ import annotations

import msgspec

import protocol
from viewer.view_status import CaseRow, RunRow

__all__ = ["RunBook"]


class RunBook:
    """Everything known of the service's runs.

    Attributes:
        cases: the cases on offer.
        runs: every run by id, in the order they became known.
        progress: the newest progress of each run.
        working_lists: the newest list of edits of each run.
        applied: the edits each run was computed with, as far as known.
        forcing: the newest forcing of each run that was watched.
        places: gauges and sections of each run that was watched.
        controllers: who controls each run, as far as told.
        control_requests: who asked last for the control of a run that is controlled from here.
    """

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Forget everything: another service has other runs."""
        self.cases: tuple[protocol.CaseSummary, ...] = ()
        self.runs: dict[str, protocol.RunInfo] = {}
        self.progress: dict[str, protocol.Progress] = {}
        self.working_lists: dict[str, protocol.EditsChanged] = {}
        self.applied: dict[str, tuple[protocol.Edit, ...]] = {}
        self.forcing: dict[str, protocol.ForcingChanged] = {}
        self.places: dict[str, protocol.Places] = {}
        self.controllers: dict[str, protocol.ControlChanged] = {}
        self.control_requests: dict[str, protocol.ControlRequested] = {}
        self._by_revision: dict[tuple[str, int], tuple[protocol.Edit, ...]] = {}

    def note_run(self, info: protocol.RunInfo) -> None:
        """Take over what is new about a run."""
        known = self.runs.get(info.run)
        if known is not None and known.frame_count > info.frame_count:
            info = msgspec.structs.replace(info, frame_count=known.frame_count)
        self.runs[info.run] = info

    def remove(self, run: str) -> None:
        """A run is deleted."""
        self.runs.pop(run, None)
        self.controllers.pop(run, None)
        self.control_requests.pop(run, None)

    def note_control(self, message: protocol.ControlChanged) -> None:
        """Take over who controls a run; whoever asked for it is answered."""
        self.controllers[message.run] = message
        self.control_requests.pop(message.run, None)

    def note_frame_count(self, run: str, index: int) -> None:
        """A frame of `run` exists; the count in its description may be older."""
        info = self.runs.get(run)
        if info is not None and info.frame_count <= index:
            self.runs[run] = msgspec.structs.replace(info, frame_count=index + 1)

    def note_edits(self, message: protocol.EditsChanged) -> None:
        """Take over a working list of edits."""
        self.working_lists[message.run] = message
        self._by_revision[message.run, message.revision] = message.edits

    def edits_below(self, run: str, revision: int) -> tuple[protocol.Edit, ...]:
        """Return the edits in the bed below a frame of `run` that bears `revision`.

        A run without a parent is computed on the base bed. For a branch made by someone else whose list was
        not seen at that revision, the newest list of it stands in.
        """
        if run in self.applied:
            return self.applied[run]
        info = self.runs.get(run)
        if info is not None and info.parent is None:
            return ()
        known = self._by_revision.get((run, revision))
        if known is None and info is not None and info.parent is not None:
            known = self._by_revision.get((info.parent, revision))
        if known is None and run in self.working_lists:
            known = self.working_lists[run].edits
        return known or ()

    def case_rows(self) -> tuple[CaseRow, ...]:
        """Return the cases for the run panel."""
        return tuple(
            CaseRow(
                case.name,
                case.title,
                case.duration,
                case.output_interval,
                case.nrows * case.ncols,
                case.hypothetical,
            )
            for case in self.cases
        )

    def _controller(self, run: str) -> tuple[str, str]:
        control = self.controllers.get(run)
        return ("", "") if control is None or control.session is None else (control.session, control.client)

    def run_rows(self) -> tuple[RunRow, ...]:
        """Return the runs for the run panel."""
        return tuple(
            RunRow(
                run=info.run,
                parent=info.parent,
                case=info.case,
                title=info.title,
                status=info.status,
                branch_time=None if info.branch_index is None else info.branch_index * info.output_interval,
                computed_until=max(info.frame_count - 1, 0) * info.output_interval,
                duration=info.duration,
                device=info.device,
                label=info.label,
                pinned=info.pinned,
                moves=info.moves,
                controller=self._controller(info.run),
                asker=asker.session if (asker := self.control_requests.get(info.run)) else "",
            )
            for info in self.runs.values()
        )
