"""Where settings come from: flags win over the environment, that over the file, the file over defaults.

Each error is one sentence with the source, the key, the value and what is allowed.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from solver_service.errors import ServeError
from solver_service.web.setting_keys import ENVIRONMENT_PREFIX, KEYS, SettingKey, Value
from solver_service.web.settings import ServiceSettings

CONFIG_VARIABLE = f"{ENVIRONMENT_PREFIX}CONFIG"
BY_NAME = {key.name: key for key in KEYS}


@dataclass(frozen=True)
class ResolvedSettings:
    """The settings of a service and who said them.

    Attributes:
        settings: the settings.
        origins: where each value comes from, for people.
    """

    settings: ServiceSettings
    origins: dict[str, str]


def resolve_settings(
    config: Path | None, environment: Mapping[str, str], flags: Mapping[str, object]
) -> ResolvedSettings:
    """Put the settings of a service together.

    Args:
        config: the settings file, or None for the one that FEV_SERVE_CONFIG names, if any.
        environment: variables; those that begin with FEV_SERVE_ count.
        flags: values from the command line by key; None where nothing was said.

    Raises:
        ServeError: a file cannot be read, or a key or value is not allowed.
    """
    if config is None and environment.get(CONFIG_VARIABLE):
        config = Path(environment[CONFIG_VARIABLE])
    values: dict[str, Value] = {}
    origins = {key.name: "default" for key in KEYS}
    here = Path()
    if config is not None:
        for name, given in _read_file(config).items():
            values[name] = _allowed(BY_NAME[name].read(given, config.parent), name, given, f"in {config}")
            origins[name] = f"file {config}"
    for variable, text in environment.items():
        if not variable.startswith(ENVIRONMENT_PREFIX) or variable == CONFIG_VARIABLE:
            continue
        name = variable.removeprefix(ENVIRONMENT_PREFIX).lower()
        if name not in BY_NAME or variable != BY_NAME[name].variable:
            raise ServeError(f"{variable} in the environment names no setting; allowed are {_names()}")
        values[name] = _allowed(BY_NAME[name].read_text(text, here), name, text, f"of {variable}")
        origins[name] = f"environment {variable}"
    for name, given in flags.items():
        if given is not None:
            key = BY_NAME[name]
            values[name] = _allowed(key.read(given, here), name, given, f"of {key.flag}")
            origins[name] = f"flag {key.flag}"
    return ResolvedSettings(ServiceSettings(**values), origins)  # type: ignore[arg-type]


def settings_text(resolved: ResolvedSettings) -> str:
    """The settings as a settings file, each with its origin; those that are not set as comments."""
    lines = []
    for key in KEYS:
        value = getattr(resolved.settings, key.name)
        line = f"# {key.name} is not set" if value is None else f"{key.name} = {_toml(value)}"
        lines.append(f"{line}  # {resolved.origins[key.name]}")
    return "\n".join(lines) + "\n"


def reference_table() -> str:
    """The table of docs/reference/server_settings.md."""
    lines = ["| key | flag | allowed | default | meaning |", "| --- | --- | --- | --- | --- |"]
    for key in KEYS:
        flag = f"`{key.flag}`" if key.flag is not None else ""
        lines.append(
            f"| `{key.name}` | {flag} | {key.allowed_words} | {_default_words(key)} | {key.meaning} |"
        )
    return "\n".join(lines) + "\n"


def _read_file(path: Path) -> dict[str, object]:
    try:
        found: dict[str, object] = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ServeError(f"settings file {path} cannot be read: {error.strerror or error}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ServeError(f"settings file {path} is not TOML: {error}") from error
    for name in found:
        if name not in BY_NAME:
            raise ServeError(f"key {name!r} in {path} names no setting; allowed are {_names()}")
    return found


def _allowed(value: Value | None, name: str, given: object, source: str) -> Value:
    if value is None:
        shown = repr(str(given)) if isinstance(given, Path) else repr(given)
        raise ServeError(f"{name} {source} is {shown}; {BY_NAME[name].allowed_words} is allowed")
    return value


def _names() -> str:
    return ", ".join(key.name for key in KEYS)


def _toml(value: object) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(json.dumps(text) for text in value)}]"
    return json.dumps(str(value) if isinstance(value, Path) else value)


def _default_words(key: SettingKey) -> str:
    if key.name == "data_dir":
        return "the user's data folder"
    if key.name == "token_file":
        return "`token` below the data folder"
    return "" if key.default is None else f"`{_toml(key.default)}`"
