"""Name and version of the service."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

SERVER_NAME = "fev-solver"


def server_version() -> str:
    """Version of the installed distribution; "0" in a source tree that is not installed."""
    try:
        return version("flood-emergency-visualizer")
    except PackageNotFoundError:
        return "0"
