"""A table of a case file that answers with checked values, or one sentence of what is wrong."""

from __future__ import annotations

import difflib
import math
from collections.abc import Sequence
from typing import Any

from solver_service.errors import CaseError
from solver_service.scenario.keys import ARRAYS, KEYS

Point = tuple[float, float]

MISSING = object()


class Table:
    """One table of a case file.

    Args:
        file: name of the case file, for errors.
        name: name of the table in `KEYS`; "" is the top of the file.
        values: what stands in it.
        number: which of several, from 1; None where there is one.

    Raises:
        CaseError: a key is unknown.
    """

    def __init__(self, file: str, name: str, values: dict[str, Any], number: int | None = None) -> None:
        self.file = file
        self.name = name
        self.values = values
        self.number = number
        allowed = set(KEYS[name])
        allowed |= {table for table in KEYS if table and "." not in table} if not name else set()
        for key in values:
            if key not in allowed:
                raise CaseError(f"{file}: {self.label} has the unknown key '{key}'{_hint(key, allowed)}.")

    @property
    def label(self) -> str:
        """The table in sentences: [name], or [[name]] and its number."""
        if not self.name:
            return "the top of the file"
        return f"[[{self.name}]] number {self.number}" if self.name in ARRAYS else f"[{self.name}]"

    def wrong(self, key: str, allowed: str) -> CaseError:
        """The error of a key, with its value and what is allowed."""
        value = self.values.get(key, MISSING)
        said = "is missing" if value is MISSING else f"is {_short(value)}"
        return CaseError(f"{self.file}: {self.label} {key} {said}; {allowed}.")

    def has(self, key: str) -> bool:
        """Whether the key is there."""
        return key in self.values

    def only_beside(self, key: str, *others: str) -> None:
        """Refuse a key that means nothing without one of some others.

        Raises:
            CaseError: it stands alone.
        """
        if key in self.values and not any(other in self.values for other in others):
            raise self.wrong(key, f"it means something only beside {' or '.join(map(repr, others))}")

    def tables(self, key: str) -> list[Table]:
        """The tables of an array below this one; none where it is missing."""
        below = f"{self.name}.{key}" if self.name else key
        found = self.values.get(key, [])
        if not isinstance(found, list) or not all(isinstance(item, dict) for item in found):
            raise CaseError(f"{self.file}: '{below}' is not an array of tables; [[{below}]] is allowed.")
        return [Table(self.file, below, item, number) for number, item in enumerate(found, start=1)]

    def table(self, key: str) -> Table | None:
        """A table below this one; None where it is missing."""
        below = f"{self.name}.{key}" if self.name else key
        found = self.values.get(key)
        if found is None:
            return None
        if not isinstance(found, dict):
            raise CaseError(f"{self.file}: '{below}' is not a table; [{below}] is allowed.")
        return Table(self.file, below, found)

    def text(self, key: str, default: str | None = None, longest: int = 2000) -> str:
        """A text."""
        value = self.values.get(key, default)
        if not isinstance(value, str) or len(value) > longest:
            raise self.wrong(key, f"a text of up to {longest} characters is allowed")
        return value

    def choice(self, key: str, options: Sequence[str], default: str | None = None) -> str:
        """One of some words."""
        value = self.values.get(key, default)
        if value not in options:
            raise self.wrong(key, f"{', '.join(repr(option) for option in options)} is allowed")
        return str(value)

    def flag(self, key: str, default: bool = False) -> bool:
        """True or false."""
        value = self.values.get(key, default)
        if not isinstance(value, bool):
            raise self.wrong(key, "true or false is allowed")
        return value

    def number_or_none(
        self, key: str, what: str, low: float = -math.inf, high: float = math.inf
    ) -> float | None:
        """A finite number within limits, None where the key is missing."""
        return None if key not in self.values else self.real(key, what, low, high)

    def real(
        self,
        key: str,
        what: str,
        low: float = -math.inf,
        high: float = math.inf,
        default: float | None = None,
        above: bool = False,
    ) -> float:
        """A finite number.

        Args:
            key: the key.
            what: what is allowed, in words.
            low: smallest value.
            high: largest value.
            default: value where the key is missing; None: it must be there.
            above: the value must be larger than `low`, not equal to it.
        """
        value = self.values.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise self.wrong(key, f"{what} is allowed")
        if not low <= value <= high or (above and value == low):
            raise self.wrong(key, f"{what} is allowed")
        return float(value)

    def point(self, key: str) -> Point:
        """A pair of finite coordinates [m]."""
        found = _points([self.values.get(key)])
        if found is None:
            raise self.wrong(key, "a point [x, y] of two finite numbers in m is allowed")
        return found[0]

    def points(self, key: str, least: int, most: int = 4096) -> tuple[Point, ...]:
        """Several points [m]."""
        found = _points(self.values.get(key))
        if found is None or not least <= len(found) <= most:
            count = f"{least} points" if least == most else f"{least} to {most} points"
            raise self.wrong(key, f"{count} [[x, y], ...] of finite numbers in m are allowed")
        return found

    def numbers(self, key: str, count: int) -> tuple[float, ...]:
        """A list of finite numbers of a given length."""
        value = self.values.get(key)
        if not isinstance(value, list) or len(value) != count or not all(map(_is_finite, value)):
            raise self.wrong(key, f"a list of {count} finite numbers is allowed")
        return tuple(float(item) for item in value)


def _is_finite(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _points(value: object) -> tuple[Point, ...] | None:
    if not isinstance(value, list):
        return None
    for item in value:
        if not isinstance(item, list) or len(item) != 2 or not all(map(_is_finite, item)):
            return None
    return tuple((float(x), float(y)) for x, y in value)


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."


def _hint(key: str, allowed: set[str]) -> str:
    close = difflib.get_close_matches(key, allowed, n=1)
    if close:
        return f"; did you mean '{close[0]}'"
    return f"; {', '.join(sorted(allowed))} are allowed"
