"""A series of forcing from a CSV file: a header, then time and value."""

from __future__ import annotations

import csv
import math
import re
from datetime import datetime
from pathlib import Path

import protocol
from viewer.commands import CommandError

__all__ = ["read_forcing_series"]

LONGEST_FILE = 4 << 20
SPELLINGS = {
    "m3/s": ("m3/s", "m3_s", "m3s", "cms", "m^3/s"),
    "m": ("m",),
    "mm/h": ("mm/h", "mm_h", "mm/hr", "mm_hr", "mm_per_hour"),
    "another unit": (
        *("l/s", "l_s", "cfs", "ft3/s", "ft3_s", "m/s", "m_s", "cm", "mm", "ft", "in"),
        *("mm/d", "mm_d", "mm/day", "mm_day", "in/h", "in_h"),
    ),
}
"""How the header of a column may say a unit; a file in another unit than the item's is refused."""


def read_forcing_series(path: Path, unit: str, start_time: str | None) -> protocol.ForcingSeries:
    """Read a series whose first column is `time_s` (or `time`, clock times) and whose second has the values.

    Args:
        path: the file.
        unit: unit of the values.
        start_time: clock time of time 0, ISO 8601 with offset; None where the run has none.

    Raises:
        CommandError: naming file, line, and what is allowed.
    """
    try:
        if path.stat().st_size > LONGEST_FILE:
            raise CommandError(
                f"{path.name} is larger than {LONGEST_FILE >> 20} MB; a shorter one is allowed"
            )
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except OSError as error:
        raise CommandError(f"{path.name} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise CommandError(f"{path.name} is not a text file in UTF-8") from None
    rows = [(number, row) for number, row in enumerate(csv.reader(lines), 1) if row and row[0][:1] != "#"]
    if not rows:
        raise CommandError(f"{path.name} is empty; a line 'time_s,value' and values are needed")
    columns = [name.strip() for name in rows[0][1]]
    if len(columns) < 2 or columns[0] not in ("time_s", "time"):
        raise CommandError(f"{path.name}: line 1 must name the columns, 'time_s' (or 'time') and the value")
    if len(rows) == 1:
        raise CommandError(f"{path.name} has no line of values; a time and a value a line are needed")
    _check_unit(path.name, columns[1], unit)
    begin = _begin(path.name, start_time) if columns[0] == "time" else None
    if len(rows) - 1 > protocol.limits.MAX_FORCING_POINTS:
        raise CommandError(
            f"{path.name} has {len(rows) - 1} entries; up to {protocol.limits.MAX_FORCING_POINTS} are allowed"
        )
    times, values = [], []
    for number, row in rows[1:]:
        where = f"{path.name}: line {number}"
        if len(row) < 2:
            raise CommandError(f"{where} has no value")
        times.append(_seconds(where, row[0].strip(), begin))
        values.append(_number(where, row[1].strip()))
    try:
        return protocol.ForcingSeries(tuple(times), tuple(values))
    except ValueError as error:
        raise CommandError(f"{path.name}: {error}") from None


def _check_unit(file: str, column: str, unit: str) -> None:
    bracket = re.search(r"[\[(]([^\])]+)[\])]\Z", column)
    said = (bracket[1] if bracket else column).strip().lower()
    words = {word: meant for meant, spellings in SPELLINGS.items() for word in spellings}
    for word in sorted(words, key=len, reverse=True):
        if said.endswith(f"_{word}") or (bracket is not None and said == word):
            if words[word] != unit:
                raise CommandError(f"{file}: column '{column}' is in {word}; values in {unit} are allowed")
            return


def _begin(file: str, start_time: str | None) -> datetime:
    if start_time is None:
        raise CommandError(f"{file} has clock times, but the run has none; a column 'time_s' is allowed")
    return datetime.fromisoformat(start_time)


def _seconds(where: str, text: str, begin: datetime | None) -> float:
    if begin is None:
        return _number(where, text)
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        raise CommandError(f"{where} has '{text[:80]}', which is not an ISO 8601 time") from None
    if moment.tzinfo is None:
        raise CommandError(f"{where} has '{text[:80]}' without an offset like +01:00, which is needed")
    return (moment - begin).total_seconds()


def _number(where: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise CommandError(f"{where} has '{text[:80]}'; a number is allowed")
    return value
