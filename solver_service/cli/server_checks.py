"""What `fev-solver doctor` tries before a server is started: one line each, good or bad."""

from __future__ import annotations

import os
import shutil
import socket
import sqlite3
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from solver_service.errors import ServeError, ServiceError, StoreError
from solver_service.web.settings import ServiceSettings

OTHERS = 0o077
"""Rights of whoever is not the owner."""


@dataclass(frozen=True)
class Check:
    """What was found.

    Attributes:
        name: what was looked at.
        is_good: whether a server can work with it.
        words: what was found, as a clause.
    """

    name: str
    is_good: bool
    words: str


def check_server(config: Path | None, environment: Mapping[str, str]) -> list[Check]:
    """Try everything that a server needs on this machine; makes and changes nothing that stays.

    Args:
        config: the settings file, if any.
        environment: variables, as `fev-solver serve` reads them.
    """
    from solver_service.web.setting_sources import CONFIG_VARIABLE, resolve_settings

    named = config or environment.get(CONFIG_VARIABLE)
    try:
        settings = resolve_settings(config, environment, {}).settings
        checks = [Check("settings", True, f"file {named}" if named else "no file; environment and defaults")]
    except ServiceError as error:
        settings = ServiceSettings()
        checks = [Check("settings", False, f"{error}; the defaults are looked at below")]
    looks: dict[str, Callable[[ServiceSettings], str]] = {
        "data folder": _data_folder,
        "room": _room,
        "kernel cache": _kernel_cache,
        "device": _device,
        "port": _port,
        "tls": _tls,
        "token file": _token_file,
        "token store": _token_store,
    }
    for name, look in looks.items():
        try:
            checks.append(Check(name, True, look(settings)))
        except (ServiceError, OSError) as error:
            checks.append(Check(name, False, str(error)))
    return checks


def _data_folder(settings: ServiceSettings) -> str:
    folder = settings.data_dir
    if not folder.exists():
        return f"{folder} will be made in {_writable(_first_that_exists(folder))}"
    return f"{_writable(folder)} can be written"


def _room(settings: ServiceSettings) -> str:
    free = shutil.disk_usage(_first_that_exists(settings.data_dir)).free
    words = f"{free / 1e9:.1f} GB are free, {settings.reserve_bytes / 1e9:.1f} GB of them are left to others"
    if free <= settings.reserve_bytes:
        raise StoreError(f"{words}; runs would pause at once")
    if settings.store_bytes is not None and free - settings.reserve_bytes < settings.store_bytes:
        words += f"; less than the budget of {settings.store_bytes / 1e9:.1f} GB (store_bytes)"
    return words


def _kernel_cache(settings: ServiceSettings) -> str:
    import warp as wp

    from solver_service.numerics import device_names

    device_names()  # the folder is known once Warp is up
    return f"{_writable(_first_that_exists(Path(wp.config.kernel_cache_dir)))} can be written"


def _device(settings: ServiceSettings) -> str:
    from solver_service.numerics import pick_device

    return f"{settings.device} is {pick_device(settings.device)}"


def _port(settings: ServiceSettings) -> str:
    try:
        found = socket.getaddrinfo(settings.host, settings.port, type=socket.SOCK_STREAM)[0]
        with socket.socket(found[0], socket.SOCK_STREAM) as listener:
            if os.name == "posix":
                listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind(found[4])
            listener.listen(1)
    except OSError as error:
        where = f"{settings.host} port {settings.port}"
        raise ServeError(f"{where} cannot be listened on: {error.strerror or error}") from error
    port = "any port" if settings.port == 0 else f"port {settings.port}"
    return f"{settings.host} {port} is free"


def _tls(settings: ServiceSettings) -> str:
    from solver_service.web.tls import check_tls

    check_tls(settings)
    if settings.tls_certificate is None:
        is_local = settings.host in ("127.0.0.1", "::1", "localhost")
        return "not set" if is_local else f"not set: what {settings.host} sends can be read on the way"
    return f"{settings.tls_certificate} with {settings.tls_key}"


def _token_file(settings: ServiceSettings) -> str:
    from solver_service.web.auth import load_token

    path = settings.token_path
    if not path.exists():
        return f"{path} will be made in {_writable(_first_that_exists(path))}"
    load_token(path)
    if os.name == "posix" and path.stat().st_mode & OTHERS:
        raise ServeError(f"{path} can be read by others; chmod 600 keeps it to its owner")
    return f"{path} is for its owner alone"


def _token_store(settings: ServiceSettings) -> str:
    from solver_service.web.token_store import FILE_NAME

    path = settings.data_dir / FILE_NAME
    if not path.exists():
        return "no tokens yet"
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as database:
            count = database.execute("SELECT COUNT(*) FROM tokens WHERE revoked IS NULL").fetchone()[0]
    except sqlite3.Error as error:
        raise StoreError(f"{path} cannot be read: {error}") from error
    if os.name == "posix" and path.stat().st_mode & OTHERS:
        raise StoreError(f"{path} can be read by others; chmod 600 keeps it to its owner")
    return f"{count} tokens that are not revoked"


def _first_that_exists(path: Path) -> Path:
    return next(each for each in (path.absolute(), *path.absolute().parents) if each.exists())


def _writable(path: Path) -> Path:
    """The same path.

    Raises:
        StoreError: it is no folder, or nothing can be written there.
    """
    if not path.is_dir():
        raise StoreError(f"{path} is no folder")
    if not os.access(path, os.W_OK | os.X_OK):
        raise StoreError(f"{path} cannot be written")
    return path
