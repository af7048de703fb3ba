"""Commands by name, as scripts and kept settings write them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

from viewer.commands.command import Command, CommandError

__all__ = ["command_from_mapping"]

_BY_NAME: dict[str, type[Any]] = {kind.__name__: kind for kind in Command.__args__}


def command_from_mapping(entry: Mapping[str, Any]) -> Command:
    """Return the command that a script entry such as `{"command": "Seek", "time": 120.0}` names.

    Raises:
        CommandError: an unknown command, an unknown, missing or ill-typed argument, or a number that is not
            finite.
    """
    name = entry.get("command")
    kind = _BY_NAME.get(name) if isinstance(name, str) else None
    if kind is None:
        raise CommandError(f"command {name!r} is unknown; known are {', '.join(sorted(_BY_NAME))}")
    arguments = {key: value for key, value in entry.items() if key != "command"}
    fields = {field.name: field for field in dataclasses.fields(kind)}
    for key, value in arguments.items():
        if key not in fields:
            raise CommandError(
                f"{name}: argument {key!r} is unknown; allowed are {', '.join(fields) or 'none'}"
            )
        arguments[key] = _checked(f"{name}.{key}", value, str(fields[key].type))
    missing = [
        field.name
        for field in fields.values()
        if field.default is dataclasses.MISSING and field.name not in arguments
    ]
    if missing:
        raise CommandError(f"{name}: argument {missing[0]!r} is missing")
    command: Command = kind(**arguments)
    return command


def _checked(where: str, value: Any, annotation: str) -> Any:
    allowed = [part.strip() for part in annotation.split("|")]
    if value is None and "None" in allowed:
        return None
    if isinstance(value, bool):
        if "bool" in allowed:
            return value
    elif isinstance(value, (int, float)):
        if "float" in allowed and math.isfinite(value):
            return float(value)
        if "int" in allowed and isinstance(value, int):
            return value
    elif isinstance(value, str) and "str" in allowed:
        return value
    raise CommandError(f"{where} = {value!r} is not allowed; it must be {annotation} and finite")
