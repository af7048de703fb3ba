"""Uploads from their first byte to a case on offer; lives on the event loop.

An upload is received into a folder of its own, imported there by a confined process, one at a time, and then
moved to the other cases by one rename. Whatever fails, its folder goes; after a crash the next start of the
service removes what is left.
"""

from __future__ import annotations

import asyncio
import logging
import re
import secrets
import time
from collections.abc import AsyncIterable, Callable
from contextlib import AbstractAsyncContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import msgspec

from protocol import Notice
from solver_service.errors import CaseError, CaseTooLarge, RunError, ServiceError, StoreFull
from solver_service.runs import RunRegistry
from solver_service.store import CaseShelf, DataFolder, ShelvedCase, free_bytes
from solver_service.store.room import store_failure
from solver_service.uploads.import_messages import Accepted, Stage
from solver_service.uploads.import_process import ARCHIVE, SHELF
from solver_service.uploads.importer import import_case
from solver_service.uploads.upload_record import UploadRecord
from solver_service.uploads.upload_rules import UploadRules

LOG = logging.getLogger(__name__)

MAX_OPEN = 8
"""Most uploads that come in, wait or are imported at the same time."""
MAX_KEPT = 100
"""Most uploads that are remembered after their end."""
STALL_S = 30.0
WRITE_BYTES = 1 << 20
_NAME = re.compile(r"[A-Za-z0-9_-]{1,64}\Z")

Allow = Callable[[int], AbstractAsyncContextManager[None]]


@dataclass(frozen=True)
class Sender:
    """Who sends a case.

    Attributes:
        owner: id of the token; empty for the token of the file.
        label: whose it is.
        allow: asked for so many bytes on disk before they are taken; raises where they are too many.
    """

    owner: str
    label: str
    allow: Allow


class UploadDesk:
    """Takes uploads in and keeps the uploaded cases."""

    def __init__(self, registry: RunRegistry, folder: DataFolder, rules: UploadRules) -> None:
        """A desk without uploads.

        Args:
            registry: the runs, whose catalogue offers the cases.
            folder: the data folder.
            rules: what uploads may take.
        """
        self._registry = registry
        self._folder = folder
        self._rules = rules
        self._shelf = CaseShelf(folder)
        self._cases: dict[str, ShelvedCase] = {}
        self._uploads: dict[str, UploadRecord] = {}
        self._one_at_a_time = asyncio.Lock()
        self._tasks: set[asyncio.Task[None]] = set()
        for shelved in self._shelf.cases():
            self._offer(shelved)

    @property
    def uploads(self) -> tuple[UploadRecord, ...]:
        """The uploads under way and the latest that have ended, newest first."""
        return tuple(reversed(self._uploads.values()))

    @property
    def cases(self) -> tuple[ShelvedCase, ...]:
        """The uploaded cases, by name."""
        return tuple(self._cases[name] for name in sorted(self._cases))

    def upload(self, upload: str) -> UploadRecord | None:
        """An upload by its id."""
        return self._uploads.get(upload)

    def owned_bytes(self, owner: str) -> int:
        """Room that the uploaded cases of an owner take [bytes]."""
        return sum(shelved.size for shelved in self._cases.values() if shelved.owner == owner)

    async def receive(self, chunks: AsyncIterable[bytes], size: int | None, sender: Sender) -> UploadRecord:
        """Take an archive in; its import goes on after this has returned.

        Args:
            chunks: the archive as it comes.
            size: how large the sender says it is [bytes].
            sender: who sends it.

        Returns:
            The upload, which now waits for its import.

        Raises:
            RunError: too many uploads are under way.
            CaseTooLarge: it is larger than allowed.
            CaseError: it stopped coming.
            StoreError: there is no room for it, or it cannot be written.
            QuotaError: it is more than the sender may have.
        """
        self._check_size(size or 0)
        if sum(not record.is_over for record in self._uploads.values()) >= MAX_OPEN:
            raise RunError(f"{MAX_OPEN} uploads are under way; wait until one has ended")
        record = UploadRecord(f"u{secrets.token_hex(6)}", sender.label, size)
        self._remember(record)
        try:
            async with sender.allow(self._rules.archive_bytes if size is None else size):
                folder = await asyncio.to_thread(self._shelf.begin, record.upload)
                await self._write(folder / ARCHIVE, chunks, record)
        except BaseException as error:
            record.refuse(str(error) if isinstance(error, ServiceError) else "it was not sent to its end")
            await asyncio.shield(asyncio.to_thread(self._shelf.discard, record.upload))
            raise
        record.status = "waiting"
        task = asyncio.create_task(self._import(record, folder, sender))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return record

    async def remove(self, name: str) -> None:
        """Remove an uploaded case.

        Raises:
            RunError: it was not uploaded, or runs are of it.
            StoreError: it cannot be removed.
        """
        if name not in self._cases:
            raise RunError(f"there is no uploaded case {name!r}; cases that were not uploaded stay")
        users = [run.run for run in self._registry.tree if run.record.case == name]
        if users:
            few = ", ".join(users[:5]) + (" and others" if len(users) > 5 else "")
            raise RunError(f"case {name} is used by {few}; delete these runs first")
        self._registry.catalogue.remove(name)
        shelved = self._cases.pop(name)
        try:
            await asyncio.to_thread(self._shelf.remove, name)
        except ServiceError:
            self._offer(shelved)
            raise
        self._registry.audience.announce(Notice("info", f"the case {name} was removed"))

    async def close(self) -> None:
        """End all imports; nothing of them stays."""
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def _check_size(self, size: int) -> None:
        most = self._rules.archive_bytes
        if size > most:
            raise CaseTooLarge(
                f"the archive has {size} bytes or more; up to {most} are allowed (upload_bytes)"
            )

    async def _write(self, path: Path, chunks: AsyncIterable[bytes], record: UploadRecord) -> None:
        """Write what comes to the disk, a part at a time."""
        try:
            with path.open("xb") as file:
                waiting = bytearray()
                source = aiter(chunks)
                while True:
                    async with asyncio.timeout(STALL_S):
                        chunk = await anext(source, None)
                    waiting += chunk or b""
                    record.bytes_received += len(chunk or b"")
                    self._check_size(record.bytes_received)
                    if chunk is None or len(waiting) >= WRITE_BYTES:
                        await asyncio.to_thread(self._append, file, bytes(waiting))
                        waiting.clear()
                    if chunk is None:
                        return
        except TimeoutError:
            raise CaseError(f"the archive stopped coming: nothing came for {STALL_S:g} s") from None
        except OSError as error:
            raise store_failure(error, f"upload {record.upload} cannot be written") from error

    def _append(self, file: BinaryIO, data: bytes) -> None:
        if self._room() < len(data):
            raise StoreFull(f"there is no room in {self._folder.root} for an upload")
        file.write(data)

    def _room(self) -> int:
        return free_bytes(self._folder) - self._rules.reserve_bytes

    async def _import(self, record: UploadRecord, folder: Path, sender: Sender) -> None:
        """Import a received archive and offer its case; says in the record how it ended."""
        try:
            async with self._one_at_a_time:
                record.status = "importing"
                limits = self._rules.limits
                room = max(await asyncio.to_thread(self._room), 0)
                limits = msgspec.structs.replace(limits, unpacked_bytes=min(limits.unpacked_bytes, room))
                found = await import_case(folder, limits, lambda stage: _show(record, stage))
                await _to_its_end(asyncio.create_task(self._take(record, folder, found, sender)))
        except ServiceError as error:
            record.refuse(str(error))
        except asyncio.CancelledError:
            record.refuse("the service ended before it was imported")
            raise
        except Exception:  # nobody awaits this task: the log and the record are where it is told
            LOG.exception("upload %s", record.upload)
            record.refuse("the service failed to import it; its log says more")
        finally:
            await asyncio.shield(asyncio.to_thread(self._shelf.discard, record.upload))
            LOG.info("upload %s: %s %s", record.upload, record.status, record.case or record.message)

    async def _take(self, record: UploadRecord, folder: Path, found: Accepted, sender: Sender) -> None:
        """Move a case that was imported to the others."""
        summary = found.summary
        if not _NAME.match(summary.name):
            raise CaseError(f"The case is named {summary.name!r}; 1 to 64 letters, digits, '_' and '-' are.")
        if self._registry.catalogue.find(summary.name) is not None:
            raise CaseError(
                f"case.toml: [case] name is '{summary.name}', which is offered already; a name that is new is"
                " allowed (or remove that case first)."
            )
        shelved = ShelvedCase(summary, sender.owner, sender.label, time.time(), 0, found.warnings)
        size = await asyncio.to_thread(_size_of, folder / SHELF)
        async with sender.allow(size):
            shelved = await asyncio.to_thread(self._shelf.put, record.upload, folder / SHELF, shelved)
            self._offer(shelved)
        record.accept(summary.name, found.warnings)
        who = f" by {sender.label}" if sender.label else ""
        self._registry.audience.announce(Notice("info", f"the case {summary.name} was uploaded{who}"))

    def _offer(self, shelved: ShelvedCase) -> None:
        name = shelved.summary.name
        self._cases[name] = shelved
        self._registry.catalogue.add(shelved.summary, self._shelf.source(name))

    def _remember(self, record: UploadRecord) -> None:
        self._uploads[record.upload] = record
        over = [upload for upload, known in self._uploads.items() if known.is_over]
        for upload in over[: max(len(over) - MAX_KEPT, 0)]:
            del self._uploads[upload]


def _show(record: UploadRecord, stage: Stage) -> None:
    record.stage, record.done = stage.stage, stage.done


async def _to_its_end(task: asyncio.Task[None]) -> None:
    """Wait for a task that must not be left in the middle, also when whoever waits is cancelled."""
    try:
        await asyncio.shield(task)
    except asyncio.CancelledError:
        await asyncio.wait([task])
        raise


def _size_of(folder: Path) -> int:
    return sum(path.lstat().st_size for path in folder.rglob("*") if path.is_file())
