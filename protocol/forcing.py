"""What drives a flood from outside, and changes of it: inflows, levels, rain, and when breaches begin.

A run is computed with the forcing of its case and a list of changes to it. With f the factor and o the offset
of a change and s its series, or that of the case where it brings none, the item gives

    f s(t) + o

from the time on at which the run begins, linear between the entries of a series as the case's is.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from protocol.errors import ForcingError
from protocol.fields import WireStruct, plain
from protocol.limits import MAX_FORCING_CHANGES, MAX_FORCING_POINTS, MAX_ITEM_POINTS

ForcingId = Annotated[str, Meta(min_length=1, max_length=80)]
Factor = Annotated[float, Meta(ge=0, le=1000)]
Offset = Annotated[float, Meta(ge=-1000, le=1000)]
SeriesTime = Annotated[float, Meta(ge=-1e12, le=1e12)]
StartTime = Annotated[float, Meta(ge=0, le=1e9)]
Value = Annotated[float, Meta(ge=-1e8, le=1e8)]
ForcingKind = Literal["source", "discharge", "stage", "rain", "breach"]
ForcingUnit = Literal["m3/s", "m", "mm/h", "s"]


class ForcingSeries(WireStruct, frozen=True):
    """Values against time.

    Attributes:
        times: simulation times [s], each after the one before.
        values: as many values, in the unit of the item.
    """

    times: Annotated[tuple[SeriesTime, ...], Meta(min_length=1, max_length=MAX_FORCING_POINTS)]
    values: Annotated[tuple[Value, ...], Meta(min_length=1, max_length=MAX_FORCING_POINTS)]

    def __post_init__(self) -> None:
        """Refuse times that do not rise, or another number of values."""
        super().__post_init__()
        if len(self.times) != len(self.values):
            raise ValueError(
                f"A series has {len(self.times)} 'times' and {len(self.values)} 'values';"
                " as many of both are allowed"
            )
        for before, after in pairwise(self.times):
            if not after > before:
                raise ValueError(
                    f"The 'times' of a series go from {before:g} to {after:g} s; rising times are allowed"
                )


class ForcingChange(WireStruct, frozen=True):
    """How one item differs from the case.

    Attributes:
        id: id of the item.
        factor: what its values are multiplied by; 1 for levels and breaches.
        offset: what is added to a level [m]; 0 for all others.
        series: what takes the place of the case's series.
        start_time: when a breach begins [s], whatever the case says; "never", or nil as the case says.
    """

    id: ForcingId
    factor: Factor = 1.0
    offset: Offset = 0.0
    series: ForcingSeries | None = None
    start_time: StartTime | Literal["never"] | None = None

    @property
    def is_neutral(self) -> bool:
        """Whether it leaves the item as the case says."""
        return self == ForcingChange(self.id)


class ForcingItem(WireStruct, frozen=True):
    """Something that drives the flood of a case.

    Attributes:
        id: id of the item, unique among the items of its case.
        kind: inflow in the field, inflow or level at an edge, rain, or a breach.
        unit: unit of its values.
        low: smallest value allowed.
        high: largest value allowed.
        series: as the case says, thinned where the case has more entries than a message holds; of rain in
            space the largest rate anywhere.
        start_time: when the case lets a breach begin, at the earliest [s].
        overtopping: whether a breach then waits until it is overtopped.
    """

    id: ForcingId
    kind: ForcingKind
    unit: ForcingUnit
    low: float = 0.0
    high: float = 1e9
    series: ForcingSeries | None = None
    start_time: float | None = None
    overtopping: bool = False


def thinned(times: list[float], values: list[float]) -> ForcingSeries:
    """A series of at most `MAX_ITEM_POINTS` entries: evenly chosen, with the first, the last and the largest.

    Args:
        times: rising times [s].
        values: as many values.
    """
    count = len(times)
    chosen = range(count)
    if count > MAX_ITEM_POINTS:
        even = {round(k * (count - 1) / (MAX_ITEM_POINTS - 2)) for k in range(MAX_ITEM_POINTS - 1)}
        chosen = sorted(even | {max(range(count), key=values.__getitem__)})  # type: ignore[assignment]
    return ForcingSeries(tuple(times[k] for k in chosen), tuple(values[k] for k in chosen))


def check_forcing(changes: tuple[ForcingChange, ...], items: tuple[ForcingItem, ...]) -> None:
    """Refuse a list of changes that breaks a rule of its own or does not fit the items of a case.

    A change made in code has not been through the codec, so its fields are checked here too.

    Args:
        changes: the list.
        items: what the case has.

    Raises:
        ForcingError: naming the change, the field, its value and what is allowed.
    """
    known = {item.id: item for item in items}
    seen: set[str] = set()
    points = 0
    if len(changes) > MAX_FORCING_CHANGES:
        raise ForcingError(
            f"{len(changes)} changes of forcing are too many; {MAX_FORCING_CHANGES} are allowed."
        )
    for change in changes:
        try:
            msgspec.convert(plain(change), ForcingChange)
        except msgspec.ValidationError as error:
            raise ForcingError(f"The forcing of {change.id!r} is not valid: {error}.") from error
        item = known.get(change.id)
        if item is None:
            raise ForcingError(
                f"The case has no forcing {change.id!r}; {', '.join(map(repr, known)) or 'none'} is allowed."
            )
        if change.id in seen:
            raise ForcingError(f"The forcing of {change.id!r} is changed twice; once is allowed.")
        seen.add(change.id)
        points += 0 if change.series is None else len(change.series.times)
        if points > MAX_FORCING_POINTS:
            raise ForcingError(
                f"The series of {change.id!r} makes it {points} entries in all;"
                f" {MAX_FORCING_POINTS} are allowed."
            )
        _check_kind(change, item)
        _check_values(change, item)


def _check_kind(change: ForcingChange, item: ForcingItem) -> None:
    what = f"{item.kind} {item.id!r}"
    if change.start_time is not None and item.kind != "breach":
        raise ForcingError(f"The {what} has a 'start_time'; breaches alone have one.")
    if change.series is not None and item.kind == "breach":
        raise ForcingError(f"The {what} has a 'series'; a 'start_time' is allowed.")
    if change.factor != 1.0 and item.kind in ("stage", "breach"):
        allowed = "an 'offset' or a 'series'" if item.kind == "stage" else "a 'start_time'"
        raise ForcingError(f"The {what} has the 'factor' {change.factor:g}; {allowed} is allowed.")
    if change.offset != 0.0 and item.kind != "stage":
        raise ForcingError(f"The {what} has the 'offset' {change.offset:g}; levels alone have one.")
    if change.series is None and item.series is None and change.factor != 1.0:
        raise ForcingError(
            f"The {what} has the 'factor' {change.factor:g} and the case has no series; give one."
        )


def _check_values(change: ForcingChange, item: ForcingItem) -> None:
    series = change.series if change.series is not None else item.series
    if series is None or change.is_neutral:
        return
    for time, value in zip(series.times, series.values, strict=True):
        found = change.factor * value + change.offset
        if not item.low <= found <= item.high:
            raise ForcingError(
                f"The {item.kind} {item.id!r} comes to {found:g} {item.unit} at {time:g} s;"
                f" {item.low:g} to {item.high:g} {item.unit} is allowed."
            )
