"""`fev-solver serve`: settings from options, then the web layer takes over."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from solver_service.errors import ServeError


def serve_runs(
    *,
    host: str,
    port: int,
    data_dir: Path | None,
    token_file: Path | None,
    ready_file: Path | None,
    cases: tuple[str, ...],
    device: str,
    threads: int | None,
    stop_with_stdin: bool,
    allowed_origins: tuple[str, ...],
    store_bytes: int | None,
    restart_attempts: int,
) -> None:
    """Serve until told to stop; the arguments are those of `ServiceSettings`, None for its defaults.

    Raises:
        ServiceError: the port, the data folder, the token file, a case or the device cannot be used.
    """
    from solver_service.web import ServiceSettings, serve

    if threads is not None and threads < 1:
        raise ServeError(f"--threads is {threads}; 1 or more is allowed.")
    settings = ServiceSettings(
        host=host,
        port=port,
        token_file=token_file,
        ready_file=ready_file,
        stop_with_stdin=stop_with_stdin,
        cases=cases,
        device=device,
        threads=threads,
        allowed_origins=allowed_origins,
        store_bytes=store_bytes,
        restart_attempts=restart_attempts,
    )
    serve(settings if data_dir is None else dataclasses.replace(settings, data_dir=data_dir))
