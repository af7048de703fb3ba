"""What the window remembers between starts: its shape, the options of the picture, the edit tool, kept views.

Everything read back is checked like any other input: what is not valid is left out.
"""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any

from PySide6.QtCore import QByteArray, QSettings
from PySide6.QtWidgets import QMainWindow

from viewer.commands import ChangeEditSettings, CommandError, FlyTo, command_from_mapping
from viewer.gui.view_menu import OptionValue
from viewer.tools import Bindings
from viewer.view_status import EditSettings

__all__ = ["KeptSettings"]

LAYOUT_VERSION = 4
"""To be raised when docks are added or renamed; an older layout is then not restored."""
VIEWS_KEPT = 20
"""Views kept for a terrain at most."""


class KeptSettings:
    """Reads and writes the settings.

    Args:
        store: where they lie.
    """

    def __init__(self, store: QSettings) -> None:
        self._store = store

    def restore_window(self, window: QMainWindow) -> None:
        """Give the window and its docks the shape they had."""
        geometry, layout = self._store.value("window/geometry"), self._store.value("window/layout")
        if isinstance(geometry, QByteArray):
            window.restoreGeometry(geometry)
        if isinstance(layout, QByteArray):
            window.restoreState(layout, LAYOUT_VERSION)

    def keep_window(self, window: QMainWindow) -> None:
        """Remember the shape of the window and its docks."""
        self._store.setValue("window/geometry", window.saveGeometry())
        self._store.setValue("window/layout", window.saveState(LAYOUT_VERSION))

    def options(self) -> dict[str, OptionValue]:
        """Return the options of the picture, by name."""
        return {
            name: value
            for name, value in self._mapping("picture/options").items()
            if isinstance(value, (bool, str)) or (isinstance(value, float) and math.isfinite(value))
        }

    def keep_options(self, options: dict[str, OptionValue]) -> None:
        """Remember the options of the picture."""
        self._write("picture/options", options)

    def map_shown(self) -> bool:
        """Return whether the reference map is wanted."""
        return self._mapping("picture/map").get("shown") is not False

    def keep_map_shown(self, shown: bool) -> None:
        """Remember whether the reference map is wanted."""
        self._write("picture/map", {"shown": shown})

    def edit_settings(self) -> ChangeEditSettings:
        """Return the command that sets the edit tool as it was."""
        command = _command("ChangeEditSettings", self._mapping("edits/tool"))
        return command if isinstance(command, ChangeEditSettings) else ChangeEditSettings()

    def keep_edit_settings(self, settings: EditSettings) -> None:
        """Remember the settings of the edit tool."""
        self._write("edits/tool", dataclasses.asdict(settings))

    def bindings(self) -> Bindings:
        """Return what keys and mouse do."""
        return Bindings.from_mapping(self._mapping("input/bindings"))

    def keep_bindings(self, bindings: Bindings) -> None:
        """Remember what keys and mouse do."""
        self._write("input/bindings", bindings.as_mapping())

    def views(self, terrain: str) -> dict[str, FlyTo]:
        """Return the views kept for a terrain, by name."""
        views = {}
        for name, entry in self._mapping(_views_key(terrain)).items():
            command = _command("FlyTo", entry if isinstance(entry, dict) else {})
            if isinstance(command, FlyTo):
                views[name] = command
        return dict(list(views.items())[:VIEWS_KEPT])

    def keep_views(self, terrain: str, views: dict[str, FlyTo]) -> None:
        """Remember the views of a terrain."""
        newest = list(views.items())[-VIEWS_KEPT:]
        self._write(_views_key(terrain), {name: dataclasses.asdict(view) for name, view in newest})

    def _mapping(self, key: str) -> dict[str, Any]:
        text = self._store.value(key)
        try:
            value = json.loads(text) if isinstance(text, str) else {}
        except ValueError:
            return {}
        return value if isinstance(value, dict) else {}

    def _write(self, key: str, value: dict[str, Any]) -> None:
        self._store.setValue(key, json.dumps(value))


def _views_key(terrain: str) -> str:
    # A slash would open a group of the settings file.
    return f"views/{terrain.replace('/', ' ')}"


def _command(name: str, arguments: dict[str, Any]) -> object | None:
    try:
        return command_from_mapping({"command": name, **arguments})
    except CommandError:
        return None  # written by another version, or by hand
