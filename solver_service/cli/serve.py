"""`fev-solver serve`: settings from file, environment and options, then the web layer takes over."""

from __future__ import annotations

import os
from pathlib import Path


def serve_runs(config: Path | None, show_config: bool, **flags: object) -> None:
    """Serve until told to stop, or tell the settings.

    Args:
        config: the settings file, if any.
        show_config: tell the settings as a settings file and serve nothing.
        flags: fields of `ServiceSettings`; None where the command line says nothing.

    Raises:
        ServiceError: a setting is not allowed, or the port, the data folder, the token file, a case or the
            device cannot be used.
    """
    from solver_service.web import serve
    from solver_service.web.setting_sources import resolve_settings, settings_text

    resolved = resolve_settings(config, os.environ, flags)
    if show_config:
        print(settings_text(resolved), end="")
    else:
        serve(resolved.settings)
