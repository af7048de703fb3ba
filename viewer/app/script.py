"""A script: commands with the moments at which they are due.

TOML (`[[step]]` tables) or JSON (a list of objects). Each step names one thing:

    at_wall = 2.0                 wall time since the terrain is shown [s], before anything else of the step
    until_time = 600.0            wait until the run is computed to this simulation time [s]
    command = "Seek"; time = 60   a command of `viewer.commands` with its arguments
    picture = "overview.png"      write the picture into the output folder
"""

from __future__ import annotations

import json
import math
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from viewer.commands import Command, CommandError, command_from_mapping
from viewer.errors import ViewerError

__all__ = ["ScriptError", "ScriptStep", "read_script"]


class ScriptError(ViewerError):
    """A script that cannot be followed; the text names file, step and what is wrong."""


@dataclass(frozen=True)
class ScriptStep:
    """One step of a script.

    Attributes:
        at_wall: wall time since the terrain is shown before which the step waits [s].
        until_time: simulation time to be computed before the step goes on [s].
        command: what to carry out, if anything.
        picture: file name of the picture to write, if any.
    """

    at_wall: float | None = None
    until_time: float | None = None
    command: Command | None = None
    picture: str | None = None


def read_script(path: Path) -> list[ScriptStep]:
    """Return the steps of a script file.

    Raises:
        ScriptError: the file cannot be read, or a step is wrong.
    """
    try:
        text = path.read_text(encoding="utf-8")
        entries = tomllib.loads(text).get("step") if path.suffix == ".toml" else json.loads(text)
    except OSError as error:
        raise ScriptError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise ScriptError(f"{path}: {error}") from None
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise ScriptError(f"{path}: a list of steps is needed ([[step]] in TOML, a list of objects in JSON)")
    return [_step(path, number, entry) for number, entry in enumerate(entries, 1)]


def _step(path: Path, number: int, entry: dict[str, Any]) -> ScriptStep:
    rest = dict(entry)
    where = f"{path}: step {number}"
    moments: dict[str, float | None] = {}
    for key in ("at_wall", "until_time"):
        value = rest.pop(key, None)
        if value is not None and not (
            isinstance(value, (int, float)) and math.isfinite(value) and value >= 0.0
        ):
            raise ScriptError(f"{where}: {key} = {value!r} is not allowed; it must be a time from 0 s on")
        moments[key] = value
    picture = rest.pop("picture", None)
    if picture is not None and (not isinstance(picture, str) or Path(picture).name != picture):
        raise ScriptError(f"{where}: picture = {picture!r} is not allowed; it must be a plain file name")
    command = None
    if rest:
        try:
            command = command_from_mapping(rest)
        except CommandError as error:
            raise ScriptError(f"{where}: {error}") from None
    return ScriptStep(moments["at_wall"], moments["until_time"], command, picture)
