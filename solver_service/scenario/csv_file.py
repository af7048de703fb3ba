"""CSV files of a case: a header that names the columns, then lines of which the numbers are known."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

from solver_service.errors import CaseError

MAX_FILE_BYTES = 64 << 20
MAX_LINES = 1_000_000


@dataclass(frozen=True, slots=True)
class CsvLine:
    """A line below the header.

    Attributes:
        file: name of the file, for errors.
        number: which line of the file, from 1.
        columns: place of each column, the same for all lines.
        cells: text of each cell, stripped.
    """

    file: str
    number: int
    columns: dict[str, int]
    cells: list[str]

    def text(self, column: str) -> str:
        """Text of a column."""
        return self.cells[self.columns[column]]

    def wrong(self, what: str) -> CaseError:
        """The error of this line."""
        return CaseError(f"{self.file}: line {self.number} {what}.")

    def real(self, column: str, low: float = -math.inf, high: float = math.inf) -> float:
        """A finite number within limits.

        Raises:
            CaseError: it is missing, no number, or out of range.
        """
        text = self.text(column)
        if not text:
            raise self.wrong(f"has no '{column}'; a number is needed in every line, so fill the gap")
        try:
            value = float(text)
        except ValueError as error:
            raise self.wrong(f"has '{text[:80]}' in column '{column}', which is not a number") from error
        if not (math.isfinite(value) and low <= value <= high):
            limits = "a finite number" if low == -math.inf else f"a number from {low:g} to {high:g}"
            raise self.wrong(f"has {text[:80]} in column '{column}'; {limits} is allowed")
        return value


def read_csv(path: Path) -> tuple[list[str], list[CsvLine]]:
    """Column names and the lines below them; empty lines are left out.

    Raises:
        CaseError: the file cannot be read, names a column twice, or has a line of too few or too many cells.
    """
    try:
        if path.stat().st_size > MAX_FILE_BYTES:
            raise CaseError(f"{path.name}: is larger than {MAX_FILE_BYTES} bytes.")
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(file)
            rows = [
                (reader.line_num, [cell.strip() for cell in row])
                for row in reader
                if any(cell.strip() for cell in row)
            ]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise CaseError(f"{path.name}: cannot be read as CSV: {error}.") from error
    if not rows:
        raise CaseError(f"{path.name}: is empty; line 1 must name the columns.")
    columns = rows[0][1]
    if len(set(columns)) < len(columns):
        raise CaseError(f"{path.name}: line 1 names a column twice; each its own name is allowed.")
    if len(rows) > MAX_LINES:
        raise CaseError(f"{path.name}: has {len(rows)} lines; up to {MAX_LINES} are allowed.")
    places = {column: place for place, column in enumerate(columns)}
    lines = []
    for number, cells in rows[1:]:
        if len(cells) != len(columns):
            raise CaseError(
                f"{path.name}: line {number} has {len(cells)} cells; line 1 names {len(columns)} columns."
            )
        lines.append(CsvLine(path.name, number, places, cells))
    return columns, lines
