"""The data folder of a service: its layout, its lock, and the file operations that survive a power cut.

<data-dir>/service.lock     held for the life of the service; a second service is refused
<data-dir>/runs.sqlite      runs, edits, events, commit rows
<data-dir>/frames/<run>/    segment files with packed frames, append-only
<data-dir>/checkpoints/<run>/  one Zarr group per full-precision state
<data-dir>/terrain/         base beds, named by their fingerprint
<data-dir>/cases/<name>/    uploaded cases
<data-dir>/uploads/<id>/    uploads on their way; empty when no service runs
"""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path
from types import TracebackType

import platformdirs

from protocol import Layer
from solver_service.errors import StoreError

_NAME = re.compile(r"[A-Za-z0-9_-]{1,64}\Z")


def default_data_dir() -> Path:
    """The folder for user data of this platform."""
    return Path(platformdirs.user_data_dir("flood-emergency-visualizer", appauthor=False))


def fsync_file(path: Path) -> None:
    """Force one file to the disk."""
    descriptor = os.open(path, os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def fsync_folder(path: Path) -> None:
    """Force the entries of a folder to the disk (a no-op where folders cannot be opened, as on Windows)."""
    if os.name == "nt":
        return
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


class DataFolder:
    """Paths below one data folder. Ids are checked here, so that no path ever comes from a message."""

    def __init__(self, root: Path) -> None:
        """Make the folder where it does not exist.

        Raises:
            StoreError: the folder cannot be made or written.
        """
        self.root = root
        try:
            for name in ("frames", "checkpoints", "terrain", "cases", "uploads"):
                (root / name).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StoreError(f"data folder {root} cannot be used: {error.strerror or error}") from error
        self._lock: _FileLock | None = None

    @property
    def database(self) -> Path:
        """The SQLite file."""
        return self.root / "runs.sqlite"

    def frames(self, run: str) -> Path:
        """Folder of the segment files of a run."""
        return self.root / "frames" / _checked(run)

    def checkpoints(self, run: str) -> Path:
        """Folder of the checkpoints of a run."""
        return self.root / "checkpoints" / _checked(run)

    def terrain(self, fingerprint: str) -> Path:
        """File of a base bed."""
        return self.root / "terrain" / f"{_checked(fingerprint)}.zst"

    def layer(self, fingerprint: str, layer: Layer) -> Path:
        """File of a picture of the terrain whose base bed has that name."""
        return self.root / "terrain" / f"{_checked(fingerprint)}.{layer}"

    def case(self, name: str) -> Path:
        """Folder of an uploaded case."""
        return self.root / "cases" / _checked(name)

    def upload(self, upload: str) -> Path:
        """Folder of an upload on its way."""
        return self.root / "uploads" / _checked(upload)

    def lock(self) -> None:
        """Take the folder for this process until `unlock` or the end of the process.

        Raises:
            StoreError: another service holds it, or it cannot be written.
        """
        self._lock = _FileLock(self.root / "service.lock")

    def unlock(self) -> None:
        """Give the folder back."""
        if self._lock is not None:
            self._lock.release()
            self._lock = None

    def remove_unfinished(self) -> None:
        """Delete what a crash left half-written: temporary folders and files, never anything with a row.

        A worker of the service before may be ending just now and delete the same.
        """
        for folder in (self.root / "checkpoints").glob("*/*.writing"):
            shutil.rmtree(folder, ignore_errors=True)
        for file in (self.root / "terrain").glob("*.writing"):
            file.unlink(missing_ok=True)
        for folder in (self.root / "uploads").iterdir():
            shutil.rmtree(folder, ignore_errors=True)

    def __enter__(self) -> DataFolder:
        """Lock on entry."""
        self.lock()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Unlock on exit."""
        self.unlock()


def _checked(name: str) -> str:
    if not _NAME.match(name):
        raise StoreError(f"id {name!r} is not 1 to 64 letters, digits, '_' or '-'")
    return name


class _FileLock:
    """An advisory lock that the operating system releases when the process ends, however it ends."""

    def __init__(self, path: Path) -> None:
        try:
            self._file = path.open("a+")
        except OSError as error:
            raise StoreError(
                f"data folder {path.parent} cannot be used: {error.strerror or error}"
            ) from error
        try:
            self._acquire()
        except OSError as error:
            self._file.seek(0)
            holder = self._file.read().strip() or "unknown"
            self._file.close()
            raise StoreError(
                f"data folder {path.parent} is in use by another service (process {holder}); "
                "stop it or choose another folder with --data-dir"
            ) from error
        self._file.seek(0)
        self._file.truncate()
        self._file.write(str(os.getpid()))
        self._file.flush()

    def _acquire(self) -> None:
        if os.name == "nt":
            import msvcrt

            self._file.seek(1 << 30)
            msvcrt.locking(self._file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        else:
            import fcntl

            fcntl.flock(self._file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)

    def release(self) -> None:
        self._file.close()
