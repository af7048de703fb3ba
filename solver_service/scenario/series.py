"""Time series from CSV: a header, then time and value; what is wrong is refused, what is odd is told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from solver_service.errors import CaseError
from solver_service.scenario.csv_file import CsvLine, read_csv
from solver_service.scenario.quantities import Quantity, unit_of_column

GAP = 10.0
"""A time between two entries this many times the usual one is told as a gap."""


@dataclass(frozen=True)
class Series:
    """Values against time.

    Attributes:
        times: [s], increasing.
        values: as many values, in SI units.
    """

    times: NDArray[np.float64]
    values: NDArray[np.float64]

    @staticmethod
    def constant(value: float) -> Series:
        """One value for all times."""
        return Series(np.array([0.0]), np.array([value]))


def read_series(
    path: Path, start_time: datetime | None, quantity: Quantity, unit: str | None = None
) -> Series:
    """Read a series.

    The first line names the columns: `time_s` for seconds since the start of the run, or `time` for ISO-8601
    clock times with an offset (then the case needs a start_time), and the value.

    Args:
        path: the file.
        start_time: clock time of time 0.
        quantity: what the values are.
        unit: their unit as the case declares it; None where it does not.

    Raises:
        CaseError: naming file, line, and what is allowed.
    """
    columns, lines = read_csv(path)
    read_time = time_reader(path.name, columns, start_time)
    value = columns[1]
    factor = quantity.units[_unit(path.name, value, quantity, unit)]
    scale = factor / quantity.units[quantity.unit]
    times: list[float] = []
    values: list[float] = []
    for line in lines:
        times.append(read_time(line, times[-1] if times else None))
        values.append(line.real(value) * scale)
        if not quantity.low <= values[-1] <= quantity.high:
            raise line.wrong(
                f"has a {quantity.name} of {values[-1]:g} {quantity.unit}; {quantity.low:g} to"
                f" {quantity.high:g} {quantity.unit} is allowed, so check unit and sign"
            )
    if not times:
        raise CaseError(f"{path.name}: has no line of values.")
    return Series(np.array(times), np.array(values) * quantity.units[quantity.unit])


def time_reader(
    file: str, columns: list[str], start_time: datetime | None
) -> Callable[[CsvLine, float | None], float]:
    """What reads the time [s] of a line and refuses one that is not after the time before it.

    Raises:
        CaseError: the first column is no time, or clock times lack a start_time.
    """
    if len(columns) < 2 or columns[0] not in ("time_s", "time"):
        raise CaseError(f"{file}: line 1 must name the columns, 'time_s' (or 'time') and the value.")
    if columns[0] == "time" and start_time is None:
        raise CaseError(f"{file}: has clock times, and then [case] start_time is needed.")

    def read(line: CsvLine, before: float | None) -> float:
        if columns[0] == "time" and start_time is not None:
            time = _seconds(line, start_time)
        else:
            time = line.real("time_s", -1e12, 1e12)
        if before is not None and time <= before:
            raise line.wrong(f"is at {time:.10g} s, not after {before:.10g} s; increasing times are allowed")
        return time

    return read


def _seconds(line: CsvLine, start_time: datetime) -> float:
    text = line.text("time")
    try:
        moment = datetime.fromisoformat(text)
    except ValueError as error:
        raise line.wrong(f"has '{text[:80]}', which is not an ISO-8601 time") from error
    if moment.tzinfo is None:
        raise line.wrong(f"has '{text[:80]}' without an offset like +01:00 or Z, which is needed")
    return (moment - start_time).total_seconds()


def _unit(file: str, column: str, quantity: Quantity, declared: str | None) -> str:
    named = unit_of_column(column)
    if named is not None and named not in quantity.units:
        raise CaseError(
            f"{file}: column '{column}' is in {named}; a {quantity.name} in"
            f" {quantity.allowed_units} is allowed."
        )
    if named is not None and declared is not None and named != declared:
        raise CaseError(f"{file}: column '{column}' is in {named}, but the case says unit = '{declared}'.")
    return named or declared or quantity.unit


def odd_things(name: str, series: Series, quantity: Quantity, duration: float) -> list[str]:
    """Sentences about what is allowed in a series and yet looks like a mistake.

    Args:
        name: of the file.
        series: its times and values.
        quantity: what the values are.
        duration: of the run [s].

    Raises:
        CaseError: the series ends before the run begins.
    """
    times, si = series.times, quantity.units[quantity.unit]
    if times[-1] < 0.0:
        raise CaseError(
            f"{name}: ends at {times[-1]:.10g} s, before the run begins; times from 0 to {duration:g} s are"
            " allowed, so check [case] start_time."
        )
    told = []
    largest = float(np.abs(series.values).max()) / si
    if largest > quantity.odd:
        told.append(f"{name}: a {quantity.name} of {largest:g} {quantity.unit} is odd; is the unit right?")
    if times[0] > 0.0:
        told.append(f"{name}: begins at {times[0]:g} s, after the start of the run.")
    if times.size > 1 and times[-1] < duration and series.values[-1] != 0.0:
        told.append(
            f"{name}: ends at {times[-1]:g} s and the run at {duration:g} s; its last value of"
            f" {series.values[-1] / si:g} {quantity.unit} is held."
        )
    steps = np.diff(times)
    if steps.size >= 3 and steps.max() > GAP * np.median(steps):
        at = int(steps.argmax())
        told.append(
            f"{name}: says nothing between {times[at]:g} and {times[at + 1]:g} s, {GAP:g} times its usual"
            " interval or more; is a part missing?"
        )
    return told
