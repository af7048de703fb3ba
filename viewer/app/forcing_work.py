"""The working forcing of the shown run: changed item by item, and what panels show of it."""

from __future__ import annotations

from pathlib import Path

import msgspec

import protocol
from viewer.app.forcing_series import read_forcing_series
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.commands import ChangeForcing, Command, CommandError, ResetForcing
from viewer.view_status import ForcingRow, time_text

__all__ = ["ForcingWork", "forcing_rows"]

Changes = tuple[protocol.ForcingChange, ...]


class ForcingWork:
    """Makes lists of changes of single wishes; the service has the last word.

    Args:
        desk: the dealings with the service.
    """

    def __init__(self, desk: ServiceDesk) -> None:
        self._desk = desk
        self._sent: dict[str, list[Changes]] = {}

    def carry_out(self, command: Command, shown: ShownRun | None) -> bool:
        """Carry out a command about the forcing of the shown run; return False when it is none.

        Raises:
            CommandError: there is no run, no such item, or a file cannot be read.
            ForcingError: the change does not fit the case.
        """
        if not isinstance(command, ChangeForcing | ResetForcing):
            return False
        if shown is None:
            raise CommandError("no run is shown yet")
        told = self._told(shown.run)
        if isinstance(command, ResetForcing):
            changes = tuple(each for each in self.changes(shown.run) if command.item not in (None, each.id))
        else:
            item = next((item for item in told.items if item.id == command.item), None)
            if item is None:
                known = ", ".join(item.id for item in told.items)
                raise CommandError(f"the case has no forcing {command.item!r}; there are {known}")
            wanted = _changed(self._change(shown.run, item.id), command, item, shown)
            rest = tuple(each for each in self.changes(shown.run) if each.id != item.id)
            changes = rest if wanted.is_neutral else (*rest, wanted)
        protocol.check_forcing(changes, told.items)
        if changes != self.changes(shown.run):
            self._send(shown.run, changes)
        return True

    def changes(self, run: str) -> Changes:
        """The working list of a run: as it was asked for last, else as the service told it."""
        if self._sent.get(run):
            return self._sent[run][-1]
        told = self._desk.book.forcing.get(run)
        return told.changes if told is not None else ()

    def revision(self, run: str) -> int | None:
        """Revision of the working list, unconfirmed changes included; None before the service told it."""
        told = self._desk.book.forcing.get(run)
        return None if told is None else told.revision + len(self._sent.get(run, ()))

    def for_start(self, case: str, shown: ShownRun | None) -> Changes:
        """The working list for a new run of a case.

        Raises:
            CommandError: the shown run is of another case.
        """
        if shown is None or shown.info.case != case:
            raise CommandError(f"the forcing is that of the shown run, which is not of the case {case!r}")
        return self.changes(shown.run)

    def _told(self, run: str) -> protocol.ForcingChanged:
        told = self._desk.book.forcing.get(run)
        if told is None:
            raise CommandError("the service has not told the forcing of this run")
        return told

    def _change(self, run: str, item: str) -> protocol.ForcingChange:
        found = [each for each in self.changes(run) if each.id == item]
        return found[0] if found else protocol.ForcingChange(item)

    def _send(self, run: str, changes: Changes) -> None:
        self._sent.setdefault(run, []).append(changes)

        def settled(_answer: object) -> None:
            self._sent[run].remove(changes)

        self._desk.ask(
            lambda number: protocol.ChangeForcing(number, run=run, changes=changes),
            "change the forcing",
            settled,
            settled,
        )


def _changed(
    held: protocol.ForcingChange, command: ChangeForcing, item: protocol.ForcingItem, shown: ShownRun
) -> protocol.ForcingChange:
    changed = held
    if command.factor is not None:
        changed = msgspec.structs.replace(changed, factor=command.factor)
    if command.offset is not None:
        changed = msgspec.structs.replace(changed, offset=command.offset)
    if command.series_file is not None:
        series = None
        if command.series_file:
            series = read_forcing_series(Path(command.series_file), item.unit, shown.info.start_time)
        changed = msgspec.structs.replace(changed, series=series)
    if command.start is not None:
        if isinstance(command.start, str) and command.start not in ("never", "case"):
            raise CommandError(f"a breach starts at a time [s], 'never' or 'case', not {command.start!r}")
        start = None if command.start == "case" else command.start
        changed = msgspec.structs.replace(changed, start_time=start)
    return changed


def forcing_rows(told: protocol.ForcingChanged | None, changes: Changes) -> tuple[ForcingRow, ...]:
    """The items of a run for the forcing panel.

    Args:
        told: what the service said; None before it did.
        changes: the working list as it is shown.
    """
    if told is None:
        return ()
    wanted = {change.id: change for change in changes}
    applied = {change.id: change for change in told.applied if not change.is_neutral}
    return tuple(
        _row(
            item,
            wanted.get(item.id) or protocol.ForcingChange(item.id),
            is_pending=wanted.get(item.id) != applied.get(item.id),
        )
        for item in told.items
    )


def _row(item: protocol.ForcingItem, change: protocol.ForcingChange, is_pending: bool) -> ForcingRow:
    start = change.start_time
    return ForcingRow(
        id=item.id,
        kind=item.kind,
        unit=item.unit,
        case_text=_case_text(item),
        factor=change.factor,
        offset=change.offset,
        series_text="" if change.series is None else _series_text(change.series, item.unit),
        start=start if start is not None else "case",
        case_start=item.start_time or 0.0,
        is_changed=not change.is_neutral,
        is_pending=is_pending,
    )


def _case_text(item: protocol.ForcingItem) -> str:
    if item.kind == "breach":
        waits = "when overtopped, from " if item.overtopping else "at "
        return f"{waits}{time_text(item.start_time or 0.0)}"
    return "none" if item.series is None else _series_text(item.series, item.unit)


def _series_text(series: protocol.ForcingSeries, unit: str) -> str:
    low, high = min(series.values), max(series.values)
    if low == high:
        return f"{high:.4g} {unit}"
    peak = series.times[series.values.index(high)]
    return f"{low:.4g} to {high:.4g} {unit}, highest at {time_text(max(peak, 0.0))}"
