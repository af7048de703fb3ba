"""View options by name, as menus and scripts set them."""

from __future__ import annotations

import dataclasses
import math

from viewer.commands import CommandError
from viewer.render import RenderOptions
from viewer.units import UNITS
from viewer.world import WaterColour

__all__ = ["OPTION_NAMES", "changed_options"]

_SWITCHES = (
    "wireframe",
    "show_blocks",
    "show_water",
    "show_terrain",
    "show_sky",
    "show_imagery",
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
OPTION_NAMES = (*_SWITCHES, *_NUMBERS, "water_colour", "units")


def changed_options(options: RenderOptions, name: str, value: bool | float | str) -> RenderOptions:
    """Return `options` with option `name` set to `value`.

    Raises:
        CommandError: an unknown name or a value that is not allowed.
    """
    if name == "water_colour":
        known = [colour.value for colour in WaterColour]
        if value not in known:
            raise CommandError(
                f"option water_colour = {value!r} is not allowed; allowed are {', '.join(known)}"
            )
        return dataclasses.replace(options, water_colour=WaterColour(value))
    if name == "units":
        if isinstance(value, str) and value in UNITS:
            return dataclasses.replace(options, units=UNITS[value])
        raise CommandError(f"option units = {value!r} is not allowed; it must be {' or '.join(UNITS)}")
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
