"""View options by name, as menus and scripts set them."""

from __future__ import annotations

import dataclasses
import math

from viewer.commands import CommandError
from viewer.lod import BLOCK_SIZES, Border
from viewer.render import RenderOptions
from viewer.units import UNITS
from viewer.world import WaterColour

__all__ = ["OPTION_NAMES", "changed_options", "option_values"]

_SWITCHES = (
    "wireframe",
    "show_blocks",
    "show_water",
    "show_terrain",
    "show_sky",
    "show_imagery",
    "show_edits",
    "show_gauges",
    "show_text",
    "full_mesh",
    "fog",
    "flow_arrows",
)
_NUMBERS = {
    "exaggeration": (0.1, 20.0),
    "tau_px": (0.1, 100.0),
    "contour_interval": (0.0, 1000.0),
    "light_azimuth_deg": (0.0, 360.0),
    "light_elevation_deg": (5.0, 90.0),
}
_CHOICES: dict[str, dict[float | str, object]] = {
    "water_colour": {colour.value: colour for colour in WaterColour},
    "units": {name: units for name, units in UNITS.items()},
    "block_size": {size: size for size in BLOCK_SIZES},
    "border": {border.value: border for border in Border},
}
OPTION_NAMES = (*_SWITCHES, *_NUMBERS, *_CHOICES)


def changed_options(options: RenderOptions, name: str, value: bool | float | str) -> RenderOptions:
    """Return `options` with option `name` set to `value`.

    Raises:
        CommandError: an unknown name or a value that is not allowed.
    """
    if name in _CHOICES:
        allowed = _CHOICES[name]
        if isinstance(value, bool) or value not in allowed:
            known = ", ".join(str(choice) for choice in allowed)
            raise CommandError(f"option {name} = {value!r} is not allowed; allowed are {known}")
        return dataclasses.replace(options, **{name: allowed[value]})  # type: ignore[arg-type]
    if name in _SWITCHES and isinstance(value, bool):
        return dataclasses.replace(options, **{name: value})  # type: ignore[arg-type]
    if name in _NUMBERS and isinstance(value, (int, float)) and not isinstance(value, bool):
        low, high = _NUMBERS[name]
        if math.isfinite(value) and low <= value <= high:
            return dataclasses.replace(options, **{name: float(value)})  # type: ignore[arg-type]
        raise CommandError(f"option {name} = {value!r} is not allowed; it must be from {low:g} to {high:g}")
    if name not in OPTION_NAMES:
        raise CommandError(f"option {name!r} is unknown; known are {', '.join(OPTION_NAMES)}")
    kind = "a number" if name in _NUMBERS else "true or false"
    raise CommandError(f"option {name} = {value!r} is not allowed; it must be {kind}")


def option_values(options: RenderOptions) -> tuple[tuple[str, bool | float | str], ...]:
    """Return every option with its value, as `changed_options` takes them."""
    values: list[tuple[str, bool | float | str]] = []
    for name in OPTION_NAMES:
        value = getattr(options, name)
        if name in _CHOICES:
            value = next(key for key, chosen in _CHOICES[name].items() if chosen == value)
        values.append((name, value))
    return tuple(values)
