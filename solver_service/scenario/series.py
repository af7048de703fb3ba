"""Time series from CSV: a header, then time and value, linear between."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from solver_service.errors import CaseError

MAX_FILE_BYTES = 64 << 20


@dataclass(frozen=True)
class Series:
    """Values against time.

    Attributes:
        times: [s], increasing.
        values: as many values.
    """

    times: NDArray[np.float64]
    values: NDArray[np.float64]


def read_series(path: Path, start_time: datetime | None = None) -> Series:
    """Read a series of values that are not negative.

    The first line names the columns: `time_s` for seconds since the start of the run, or `time` for ISO-8601
    clock times with an offset (then the case needs a start_time), and the value.

    Raises:
        CaseError: naming file, line, and what is allowed.
    """
    try:
        if path.stat().st_size > MAX_FILE_BYTES:
            raise CaseError(f"{path.name}: is larger than {MAX_FILE_BYTES} bytes.")
        with path.open(newline="", encoding="utf-8-sig") as lines:
            rows = [row for row in csv.reader(lines) if any(cell.strip() for cell in row)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise CaseError(f"{path.name}: cannot be read as CSV: {error}.") from error
    if not rows or len(rows[0]) < 2 or rows[0][0].strip() not in ("time_s", "time"):
        raise CaseError(f"{path.name}: line 1 must name the columns, 'time_s' (or 'time') and the value.")
    clock = rows[0][0].strip() == "time"
    if clock and start_time is None:
        raise CaseError(f"{path.name}: has clock times, and then [case] start_time is needed.")
    times: list[float] = []
    values: list[float] = []
    for number, row in enumerate(rows[1:], start=2):
        try:
            time = _seconds(row[0], start_time) if clock and start_time else float(row[0])
            value = float(row[1])
        except (ValueError, IndexError, TypeError) as error:
            raise CaseError(
                f"{path.name}: line {number} '{','.join(row)[:80]}' is not a time and a number."
            ) from error
        if not (math.isfinite(time) and math.isfinite(value)) or value < 0.0:
            raise CaseError(
                f"{path.name}: line {number} has {value} at {time} s; finite numbers, values at or"
                " above 0, are allowed."
            )
        if times and time <= times[-1]:
            raise CaseError(
                f"{path.name}: line {number} is at {time} s, not after {times[-1]} s; increasing"
                " times are allowed."
            )
        times.append(time)
        values.append(value)
    if not times:
        raise CaseError(f"{path.name}: has no line of values.")
    return Series(np.array(times), np.array(values))


def _seconds(text: str, start_time: datetime) -> float:
    moment = datetime.fromisoformat(text.strip())
    if moment.tzinfo is None:
        raise ValueError("no offset")
    return (moment - start_time).total_seconds()


def read_points(path: Path) -> list[tuple[str, float, float]]:
    """Named points from a CSV with a header that names `id` and x, y (or x_m, y_m).

    Raises:
        CaseError: naming file, line, and what is allowed.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as lines:
            rows = list(csv.DictReader(lines))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise CaseError(f"{path.name}: cannot be read as CSV: {error}.") from error
    points = []
    for number, row in enumerate(rows, start=2):
        try:
            x, y = (float(row[name] if name in row else row[f"{name}_m"]) for name in ("x", "y"))
            points.append((row["id"].strip(), x, y))
        except (KeyError, ValueError, TypeError, AttributeError) as error:
            raise CaseError(
                f"{path.name}: line {number} has no id, x and y; columns id, x, y are allowed."
            ) from error
        if not (math.isfinite(x) and math.isfinite(y)):
            raise CaseError(f"{path.name}: line {number} is at ({x}, {y}); finite coordinates are allowed.")
    return points
