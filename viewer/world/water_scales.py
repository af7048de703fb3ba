"""What water may be coloured by: classes that emergency decisions turn on, and their colours.

Depth [m]: 0.15 stops walking children, 0.3 floats small cars, 0.5 stops most cars, 0.76 (30 inches) stops
emergency trucks, 1 and 2 threaten adults and ground floors.
Speed [m/s]: up to 0.25 hardly felt, from 1 wading is hard, from 2 it is unsafe for adults, 3 is the limit for
people and vehicles at any depth (Shand et al. 2011, Australian Rainfall and Runoff, Project 10).
Hazard: HR = d (v + 0.5) + DF with the classes of Defra and Environment Agency, FD2320/TR2 (2005) and its
supplementary note (2008): below 0.75 caution, then danger for some (children, the elderly), from 1.25 for
most, from 2 for all, rescue services too.

Each row of colours runs in one direction of lightness, and neighbours stay `LEAST_COLOUR_DISTANCE` apart in
CIELAB for normal, deuteranopic, protanopic and tritanopic sight.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from viewer.units import METRIC, Units

__all__ = ["DEPTH_SCALE", "ClassScale", "WaterColour", "arrival_scale", "hazard_rating", "water_scale"]

Colour = tuple[int, int, int]

LEAST_COLOUR_DISTANCE = 12.0
"""Least CIE 1976 distance between neighbouring classes, whatever the colour vision."""
SHALLOW_DEPTH_M = 0.25
"""Up to this depth debris counts half in the hazard rating."""
ARRIVAL_CLASSES = 7
_ARRIVAL_STEPS_S = (10, 20, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10_800, 21_600, 43_200, 86_400)


class WaterColour(Enum):
    """How water is coloured."""

    NATURAL = "natural"
    """Reflection, refraction and absorption with depth."""
    DEPTH = "depth"
    SPEED = "speed"
    HAZARD = "hazard"
    MAX_DEPTH = "max_depth"
    MAX_SPEED = "max_speed"
    MAX_HAZARD = "max_hazard"
    ARRIVAL = "arrival"

    @property
    def channel(self) -> str | None:
        """The optional channel of a run that it is read from; None for what every frame has."""
        if self in (WaterColour.NATURAL, WaterColour.DEPTH):
            return None
        return "velocity" if self in (WaterColour.SPEED, WaterColour.HAZARD) else "maxima"


@dataclass(frozen=True)
class ClassScale:
    """Classes of a quantity.

    A value belongs to the class whose lower limit it reaches, compared in float32 as pictures compare.
    """

    heading: str
    """Quantity and unit, for the legend."""
    limits: tuple[float, ...]
    """Lower limits of all classes but the first, rising."""
    colours: tuple[Colour, ...]
    """One sRGB colour a class."""
    labels: tuple[str, ...]
    """Text of each class."""

    def class_of(self, values: npt.ArrayLike) -> npt.NDArray[np.intp]:
        """Index of the class of each value: 0 below the first limit, and so on."""
        limits = np.asarray(self.limits, dtype=np.float32)
        return np.searchsorted(limits, np.asarray(values, dtype=np.float32), side="right")


def hazard_rating(depth: npt.NDArray[np.float32], speed: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Hazard rating d (v + 0.5) + DF with DF = 0.5 up to 0.25 m of depth, else 1 (FD2320/TR2).

    Args:
        depth: [m], float32.
        speed: [m/s], float32, same shape.
    """
    half = np.float32(0.5)
    debris = np.where(depth <= np.float32(SHALLOW_DEPTH_M), half, np.float32(1.0))
    rating: npt.NDArray[np.float32] = depth * (speed + half) + debris
    return rating


def arrival_scale(duration: float, clock_text: Callable[[float], str] | None = None) -> ClassScale:
    """Classes of the time at which water came first: the earliest darkest.

    Args:
        duration: length of the run [s], > 0.
        clock_text: from a simulation time [s] to the text of a moment; None writes hours and minutes.
    """
    step = next((s for s in _ARRIVAL_STEPS_S if s * ARRIVAL_CLASSES >= duration), duration / ARRIVAL_CLASSES)
    limits = tuple(float(step * k) for k in range(1, ARRIVAL_CLASSES))
    texts = [(clock_text or _moment)(limit) for limit in limits]
    between = [f"{low} - {high}" for low, high in pairwise(texts)]
    labels = (f"before {texts[0]}", *between, f"from {texts[-1]}")
    return ClassScale("Water arrives", limits, _ARRIVAL_COLOURS, labels)


def water_scale(
    colour: WaterColour,
    duration: float,
    clock_text: Callable[[float], str] | None = None,
    units: Units = METRIC,
) -> ClassScale | None:
    """Classes of a way to colour; None for natural water.

    Args:
        colour: the way.
        duration: length of the run [s], for arrival times.
        clock_text: as for `arrival_scale`.
        units: units of heading and labels; limits stay in SI, and hazard ratings are what they are.
    """
    if colour is WaterColour.ARRIVAL:
        return arrival_scale(duration, clock_text)
    made = _SCALES.get(colour)
    return None if made is None else made(units)


def _moment(seconds: float) -> str:
    if seconds % 60.0:
        return f"{int(seconds) // 60}:{int(seconds) % 60:02d} min"
    minutes = int(seconds) // 60
    return f"{minutes // 60}:{minutes % 60:02d} h" if minutes >= 60 else f"{minutes} min"


def _limit_labels(limits: tuple[float, ...], units: Units) -> tuple[str, ...]:
    texts = [f"{limit:g}" if units is METRIC else f"{units.shown(limit):.2g}" for limit in limits]
    return (f"< {texts[0]}", *(f"{low} - {high}" for low, high in pairwise(texts)), f"> {texts[-1]}")


_DEPTH_LIMITS = (0.15, 0.3, 0.5, 0.76, 1.0, 2.0)
_DEPTH_COLOURS: tuple[Colour, ...] = (
    (255, 247, 188),
    (254, 217, 118),
    (250, 158, 84),
    (232, 96, 100),
    (200, 60, 125),
    (130, 35, 140),
    (60, 15, 95),
)
_SPEED_LIMITS = (0.25, 0.5, 1.0, 2.0, 3.0, 5.0)
_SPEED_COLOURS: tuple[Colour, ...] = (
    (248, 250, 220),
    (190, 228, 170),
    (110, 195, 175),
    (60, 155, 190),
    (40, 108, 185),
    (48, 52, 140),
    (20, 8, 70),
)
_HAZARD_LIMITS = (0.75, 1.25, 2.0)
_HAZARD_COLOURS: tuple[Colour, ...] = ((255, 240, 160), (253, 174, 80), (222, 70, 90), (85, 10, 100))
_HAZARD_LABELS = (
    "< 0.75 caution",
    "0.75 - 1.25 danger for some",
    "1.25 - 2 danger for most",
    "> 2 danger for all",
)
_ARRIVAL_COLOURS: tuple[Colour, ...] = (
    (30, 8, 70),
    (92, 20, 110),
    (155, 40, 105),
    (210, 70, 70),
    (245, 130, 30),
    (250, 195, 60),
    (252, 250, 170),
)


def _depth_scale(quantity: str) -> Callable[[Units], ClassScale]:
    return lambda units: ClassScale(
        f"{quantity} [{units.length}]", _DEPTH_LIMITS, _DEPTH_COLOURS, _limit_labels(_DEPTH_LIMITS, units)
    )


def _speed_scale(quantity: str) -> Callable[[Units], ClassScale]:
    return lambda units: ClassScale(
        f"{quantity} [{units.speed}]", _SPEED_LIMITS, _SPEED_COLOURS, _limit_labels(_SPEED_LIMITS, units)
    )


def _hazard_scale(heading: str) -> Callable[[Units], ClassScale]:
    return lambda _: ClassScale(heading, _HAZARD_LIMITS, _HAZARD_COLOURS, _HAZARD_LABELS)


_SCALES: dict[WaterColour, Callable[[Units], ClassScale]] = {
    WaterColour.DEPTH: _depth_scale("Water depth"),
    WaterColour.SPEED: _speed_scale("Flow speed"),
    WaterColour.HAZARD: _hazard_scale("Hazard rating"),
    WaterColour.MAX_DEPTH: _depth_scale("Greatest depth"),
    WaterColour.MAX_SPEED: _speed_scale("Greatest speed"),
    WaterColour.MAX_HAZARD: _hazard_scale("Greatest hazard rating"),
}
DEPTH_SCALE = _SCALES[WaterColour.DEPTH](METRIC)
