"""Which cases the service can compute."""

from __future__ import annotations

from protocol.fields import Command, CommandId, Message, Name, Positive, Side, Text, WireStruct


class ListCases(Command, frozen=True):
    """Ask for the cases the service can compute; `case_list` is the answer."""


class CaseSummary(WireStruct, frozen=True):
    """A case in a few words.

    Attributes:
        name: what `start_run` calls it.
        title: one line for people.
        hypothetical: whether the event never happened; shown on every picture.
        nrows: rows of its grid.
        ncols: columns of its grid.
        dx: cell size [m].
        duration: simulated time by default [s].
        output_interval: time between frames by default [s].
        source: where the data comes from.
        licence: licence of the data.
    """

    name: Name
    title: Name
    hypothetical: bool
    nrows: Side
    ncols: Side
    dx: Positive
    duration: Positive
    output_interval: Positive
    source: Text = ""
    licence: Text = ""


class CaseList(Message, frozen=True):
    """Answer to `list_cases`.

    Attributes:
        id: id of the command.
        cases: the cases, by name; up to 1000.
    """

    id: CommandId
    cases: tuple[CaseSummary, ...]
