"""Uploaded cases in the data folder: they come whole by one rename, and go by one.

<data-dir>/uploads/<upload>/        what is received and imported; nothing of it outlives the service
<data-dir>/cases/<name>/case/       the files of a case
<data-dir>/cases/<name>/case.json   what is known of it, so that nobody must read its files to list it
"""

from __future__ import annotations

import logging
import os
import secrets
import shutil
import stat
from pathlib import Path

import msgspec

from protocol import CaseSummary
from solver_service.errors import StoreError
from solver_service.store.data_folder import DataFolder, fsync_file, fsync_folder
from solver_service.store.room import store_failure

FACTS = "case.json"
FILES = "case"
LOG = logging.getLogger(__name__)


class ShelvedCase(msgspec.Struct, frozen=True):
    """What is known of an uploaded case.

    Attributes:
        summary: the case in a few words.
        owner: id of the token by which it came; empty for the token of the file.
        label: whose that is.
        moment: when it came, in seconds since 1970.
        size: bytes of its files.
        warnings: what its check found odd, one sentence each.
    """

    summary: CaseSummary
    owner: str
    label: str
    moment: float
    size: int
    warnings: tuple[str, ...] = ()


class CaseShelf:
    """Uploaded cases, and the folders in which they are made ready."""

    def __init__(self, folder: DataFolder) -> None:
        self._folder = folder

    def source(self, name: str) -> str:
        """The path of the files of a case, for whoever loads it."""
        return str(self._folder.case(name) / FILES)

    def cases(self) -> list[ShelvedCase]:
        """All uploaded cases, by name; one whose facts cannot be read is told in the log and passed over."""
        found = []
        for path in sorted((self._folder.root / "cases").glob(f"*/{FACTS}")):
            try:
                shelved = msgspec.json.decode(path.read_bytes(), type=ShelvedCase)
            except (OSError, msgspec.MsgspecError) as error:
                LOG.error("the uploaded case %s is not offered: %s", path.parent.name, error)
                continue
            if shelved.summary.name == path.parent.name:
                found.append(shelved)
        return found

    def begin(self, upload: str) -> Path:
        """An empty folder for an upload.

        Raises:
            StoreError: it cannot be made.
        """
        path = self._folder.upload(upload)
        try:
            path.mkdir(mode=0o700)
        except OSError as error:
            raise store_failure(error, f"upload folder {path} cannot be made") from error
        return path

    def discard(self, upload: str) -> None:
        """Remove the folder of an upload, whatever is in it."""
        shutil.rmtree(self._folder.upload(upload), ignore_errors=True)

    def put(self, upload: str, ready: Path, shelved: ShelvedCase) -> ShelvedCase:
        """Move a case that was made ready to the others; it is there whole or not at all.

        Args:
            upload: id of the upload, whose folder then goes.
            ready: a folder in that of the upload, with the files below `case`.
            shelved: what is known of it; its size is counted here.

        Returns:
            What is now known of it.

        Raises:
            StoreError: there is a case of that name, or it cannot be written.
        """
        target = self._folder.case(shelved.summary.name)
        try:
            files = _plain_files(ready / FILES)
            shelved = msgspec.structs.replace(shelved, size=sum(path.stat().st_size for path in files))
            (ready / FACTS).write_bytes(msgspec.json.encode(shelved))
            for path in (*files, ready / FACTS):
                fsync_file(path)
            for root, _, _ in os.walk(ready):
                fsync_folder(Path(root))
            if target.exists():
                raise StoreError(f"there is an uploaded case {shelved.summary.name!r} already")
            ready.rename(target)
            fsync_folder(target.parent)
        except OSError as error:
            raise store_failure(error, f"case {shelved.summary.name} cannot be kept in {target}") from error
        self.discard(upload)
        return shelved

    def remove(self, name: str) -> None:
        """Remove a case.

        Raises:
            StoreError: it cannot be removed.
        """
        gone = self._folder.upload(f"removed-{secrets.token_hex(6)}")
        try:
            self._folder.case(name).rename(gone)
            fsync_folder(gone.parent)
        except OSError as error:
            raise store_failure(error, f"case {name} cannot be removed") from error
        shutil.rmtree(gone, ignore_errors=True)


def _plain_files(root: Path) -> list[Path]:
    """All files below a folder.

    Raises:
        StoreError: one is no plain file.
    """
    found = []
    for folder, folders, names in os.walk(root):
        for name in (*folders, *names):
            path = Path(folder) / name
            mode = path.lstat().st_mode
            if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
                raise StoreError(f"{path} is no plain file")
            if stat.S_ISREG(mode):
                found.append(path)
    return found
