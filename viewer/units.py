"""Metric or US customary units: how lengths, speeds, areas and volumes are written for people.

Everything inside is SI; only text and the numbers of input fields are converted, here and nowhere else. The
foot is the international foot of 0.3048 m exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["METRIC", "UNITS", "US", "Units"]

FOOT = 0.3048
"""[m]"""
MILE = 5280.0 * FOOT
ACRE = 43_560.0 * FOOT**2
"""[m2]"""


@dataclass(frozen=True)
class Units:
    """A system of units.

    Attributes:
        name: "metric" or "us".
        metre: metres that the unit of length is long.
        length: sign of the unit of length.
        far: metres that the unit of long distances is long.
        far_sign: its sign.
        field: square metres of the unit of area.
        field_sign: its sign.
    """

    name: str
    metre: float
    length: str
    far: float
    far_sign: str
    field: float
    field_sign: str

    @property
    def speed(self) -> str:
        """Sign of the unit of speed."""
        return f"{self.length}/s"

    def shown(self, metres: float) -> float:
        """A length [m] in the unit of length; speeds [m/s] alike."""
        return metres / self.metre

    def metres(self, shown: float) -> float:
        """A length in the unit of length back in metres."""
        return shown * self.metre

    def length_text(self, metres: float, digits: int = 2) -> str:
        """A depth, a level or a height [m]."""
        return f"{self.shown(metres):,.{digits}f} {self.length}"

    def distance_text(self, metres: float) -> str:
        """A distance over land [m]; long ones in the larger unit."""
        if metres >= self.far:
            return f"{metres / self.far:,.2f} {self.far_sign}"
        return f"{self.shown(metres):,.0f} {self.length}"

    def speed_text(self, metres_per_second: float) -> str:
        """A speed [m/s]."""
        return f"{self.shown(metres_per_second):.2f} {self.speed}"

    def area_text(self, square_metres: float) -> str:
        """An area [m2]; large ones in the larger unit."""
        if square_metres >= self.field:
            return f"{square_metres / self.field:,.2f} {self.field_sign}"
        return f"{square_metres / self.metre**2:,.0f} {self.length}\u00b2"

    def volume_text(self, cubic_metres: float) -> str:
        """A volume of earth or water [m3]."""
        return f"{cubic_metres / self.metre**3:,.0f} {self.length}\u00b3"

    def discharge_text(self, cubic_metres_per_second: float) -> str:
        """A discharge [m3/s]."""
        return f"{cubic_metres_per_second / self.metre**3:,.1f} {self.length}\u00b3/s"


METRIC = Units("metric", 1.0, "m", 1000.0, "km", 1e6, "km\u00b2")
US = Units("us", FOOT, "ft", MILE, "mi", ACRE, "acres")
UNITS = {METRIC.name: METRIC, US.name: US}
"""The systems by name."""
