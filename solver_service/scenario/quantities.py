"""What a series or raster of a case may hold: quantity, units and plausible values.

A unit is declared by the case (a key `unit`) or by the name of the column, `rain_mm_h` or `rain [mm/h]`;
where neither says one, the first of the quantity's units is meant.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

SPELLINGS: dict[str, str] = {
    "m3/s": "m3/s",
    "m3_s": "m3/s",
    "m3s": "m3/s",
    "m^3/s": "m3/s",
    "cms": "m3/s",
    "l/s": "l/s",
    "l_s": "l/s",
    "cfs": "ft3/s",
    "ft3/s": "ft3/s",
    "ft3_s": "ft3/s",
    "mm/h": "mm/h",
    "mm_h": "mm/h",
    "mm/hr": "mm/h",
    "mm_hr": "mm/h",
    "mm_per_hour": "mm/h",
    "mm/day": "mm/day",
    "mm_day": "mm/day",
    "mm/d": "mm/day",
    "mm_d": "mm/day",
    "in/h": "in/h",
    "in_h": "in/h",
    "in/hr": "in/h",
    "m/s": "m/s",
    "m_s": "m/s",
    "m": "m",
    "cm": "cm",
    "mm": "mm",
    "ft": "ft",
    "in": "in",
}
"""Unit meant by each spelling."""


@dataclass(frozen=True)
class Quantity:
    """What numbers mean, and which of them are believed.

    Attributes:
        name: in words.
        units: SI value of 1 of each allowed unit; the first is the default, and that of the limits.
        low: smaller values are refused.
        high: larger values are refused.
        odd: a value further from 0 is told as odd.
    """

    name: str
    units: dict[str, float]
    low: float
    high: float
    odd: float

    @property
    def unit(self) -> str:
        """The unit where none is declared."""
        return next(iter(self.units))

    @property
    def allowed_units(self) -> str:
        """The allowed units, for errors."""
        return ", ".join(self.units)

    def spellings(self, unit: str) -> tuple[str, ...]:
        """How a file may write a unit; with "" for none."""
        return ("", *(text for text, meant in SPELLINGS.items() if meant == unit and text != unit), unit)


DISCHARGE = Quantity("discharge", {"m3/s": 1.0, "l/s": 1e-3}, 0.0, 1e8, 1e6)
EDGE_DISCHARGE = Quantity("discharge", DISCHARGE.units, -1e8, 1e8, 1e6)
LEVEL = Quantity("water level", {"m": 1.0, "cm": 1e-2, "mm": 1e-3}, -20_000.0, 20_000.0, 9000.0)
RAIN = Quantity("rain", {"mm/h": 1e-3 / 3600.0, "mm/day": 1e-3 / 86400.0, "m/s": 1.0}, 0.0, 10_000.0, 500.0)


def unit_of_column(column: str) -> str | None:
    """The unit that the name of a column declares, None where it declares none.

    A unit in brackets that is not known is given as it stands.
    """
    bracket = re.search(r"[\[(]([^\])]+)[\])]\s*\Z", column)
    if bracket:
        text = bracket[1].strip()
        return SPELLINGS.get(text, text)
    for length in (3, 2, 1):  # "mm_per_hour" has three words, "m3_s" two, "cfs" one
        words = column.lower().split("_")
        if len(words) > length and "_".join(words[-length:]) in SPELLINGS:
            return SPELLINGS["_".join(words[-length:])]
    return None
