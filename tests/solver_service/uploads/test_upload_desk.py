"""Uploads at the desk of real runs: received, imported, offered, removed, and what fails on the way."""

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path

import pytest

from protocol import Notice, ServerMessage
from solver_service.errors import CaseError, CaseTooLarge, QuotaError, RunError, StoreError, StoreFull
from solver_service.runs import RunRegistry
from solver_service.store import DataFolder
from solver_service.uploads import upload_desk
from solver_service.uploads.import_messages import ImportLimits
from solver_service.uploads.upload_desk import Sender, UploadDesk
from solver_service.uploads.upload_record import UploadRecord
from solver_service.uploads.upload_rules import UploadRules
from tests.solver_service.uploads.archives import tiny

RULES = UploadRules(2_000_000, ImportLimits(probe_s=0.05), reserve_bytes=0)


class Ear:
    def __init__(self) -> None:
        self.texts: list[str] = []

    def announce(self, message: ServerMessage) -> None:
        if isinstance(message, Notice):
            self.texts.append(message.text)

    def frame_stored(self, run: str) -> None:
        pass


@contextmanager
def opened(data_dir: Path, rules: UploadRules = RULES) -> Iterator[UploadDesk]:
    """A desk of runs that are not computed here."""
    registry = RunRegistry(data_dir, spare_workers=0)
    try:
        yield UploadDesk(registry, DataFolder(data_dir), rules)
    finally:
        registry._store.close()
        registry._folder.unlock()


def sender(most: int = 1 << 40) -> Sender:
    @asynccontextmanager
    async def allow(size: int) -> AsyncIterator[None]:
        if size > most:
            raise QuotaError("max_disk_bytes", f"{size} bytes are too many")
        yield

    return Sender("0a1b2c3d", "Ada", allow)


async def chunks(data: bytes, size: int = 700) -> AsyncIterator[bytes]:
    for at in range(0, len(data), size):
        yield data[at : at + size]


async def sent(desk: UploadDesk, data: bytes, by: Sender | None = None) -> UploadRecord:
    """Send an archive and wait for the end of its import."""
    record = await desk.receive(chunks(data), len(data), by or sender())
    while not record.is_over:
        await asyncio.sleep(0.02)
    await asyncio.gather(*desk._tasks, return_exceptions=True)
    return record


def left(data_dir: Path) -> list[Path]:
    return list((data_dir / "uploads").iterdir())


def test_a_case_is_offered_survives_a_restart_and_is_removed(tmp_path: Path) -> None:
    data = tiny(tmp_path)
    with opened(tmp_path / "data") as desk:
        ear = Ear()
        desk._registry.audience.add(ear)
        record = asyncio.run(sent(desk, data))
        assert (record.status, record.case, record.bytes_received) == ("accepted", "tiny", len(data))
        assert "tiny" in [case.name for case in desk._registry.cases]
        assert ear.texts == ["the case tiny was uploaded by Ada"]
        assert desk.owned_bytes("0a1b2c3d") > len(data) / 2
        assert desk.owned_bytes("other") == 0
        second = asyncio.run(sent(desk, data))
        assert second.status == "refused"
        assert "'tiny', which is offered already" in second.message
        assert left(tmp_path / "data") == []
    with opened(tmp_path / "data") as desk:
        assert [case.summary.name for case in desk.cases] == ["tiny"]
        assert "tiny" in [case.name for case in desk._registry.cases]
        asyncio.run(desk.remove("tiny"))
        assert desk._registry.case("tiny") is None
        assert list((tmp_path / "data" / "cases").iterdir()) == []
        with pytest.raises(RunError, match="there is no uploaded case 'tiny'"):
            asyncio.run(desk.remove("tiny"))
        with pytest.raises(RunError, match="there is no uploaded case 'jacksboro'"):
            asyncio.run(desk.remove("jacksboro"))


def test_what_is_refused_leaves_nothing(tmp_path: Path) -> None:
    with opened(tmp_path / "data") as desk:
        record = asyncio.run(sent(desk, b"this is no archive"))
        assert record.status == "refused"
        assert "is no zip archive" in record.message
        assert desk.cases == ()
        assert left(tmp_path / "data") == []


@pytest.mark.parametrize("says", [True, False])
def test_an_archive_that_is_too_large_is_refused_while_it_comes(tmp_path: Path, says: bool) -> None:
    came = 0

    async def endless() -> AsyncIterator[bytes]:
        nonlocal came
        while True:
            came += 65536
            yield bytes(65536)

    with opened(tmp_path / "data") as desk:
        with pytest.raises(CaseTooLarge, match="2000000 are allowed"):
            asyncio.run(desk.receive(endless(), 1 << 40 if says else None, sender()))
        assert came <= (0 if says else 2_200_000)
        assert left(tmp_path / "data") == []


def test_a_quota_is_asked_before_anything_is_written_and_again_for_the_case(tmp_path: Path) -> None:
    data = tiny(tmp_path)
    with opened(tmp_path / "data") as desk:
        with pytest.raises(QuotaError):
            asyncio.run(desk.receive(chunks(data), len(data), sender(most=len(data) - 1)))
        record = asyncio.run(sent(desk, data, sender(most=len(data))))
        assert record.status == "refused"
        assert "bytes are too many" in record.message
        assert desk.cases == ()
        assert left(tmp_path / "data") == []


def test_a_full_disk_is_told(tmp_path: Path) -> None:
    rules = UploadRules(2_000_000, RULES.limits, reserve_bytes=1 << 60)
    with opened(tmp_path / "data", rules) as desk:
        with pytest.raises(StoreFull, match="there is no room"):
            asyncio.run(desk.receive(chunks(b"PK" * 100), None, sender()))
        assert left(tmp_path / "data") == []


def test_a_sender_that_stops_or_goes_away_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(upload_desk, "STALL_S", 0.05)

    async def stalls() -> AsyncIterator[bytes]:
        yield b"PK"
        await asyncio.sleep(60.0)

    async def goes() -> AsyncIterator[bytes]:
        yield b"PK"
        raise ConnectionResetError

    with opened(tmp_path / "data") as desk:
        with pytest.raises(CaseError, match=r"nothing came for 0.05 s"):
            asyncio.run(desk.receive(stalls(), None, sender()))
        with pytest.raises((ConnectionResetError, StoreError)):
            asyncio.run(desk.receive(goes(), None, sender()))
        assert [record.status for record in desk.uploads] == ["refused", "refused"]
        assert left(tmp_path / "data") == []


def test_too_many_uploads_at_once_are_refused(tmp_path: Path) -> None:
    async def crowd(desk: UploadDesk) -> None:
        open_end = asyncio.Event()

        async def waits() -> AsyncIterator[bytes]:
            yield b"PK"
            await open_end.wait()

        first = [asyncio.create_task(desk.receive(waits(), None, sender())) for _ in range(8)]
        await asyncio.sleep(0.05)
        with pytest.raises(RunError, match="8 uploads are under way"):
            await desk.receive(chunks(b"PK"), None, sender())
        open_end.set()
        await asyncio.gather(*first)
        await desk.close()

    with opened(tmp_path / "data") as desk:
        asyncio.run(crowd(desk))
        assert left(tmp_path / "data") == []


def test_an_end_of_the_service_in_the_middle_of_an_import_leaves_no_case(tmp_path: Path) -> None:
    async def ended(desk: UploadDesk) -> UploadRecord:
        data = tiny(tmp_path)
        record = await desk.receive(chunks(data), len(data), sender())
        while record.status != "importing":
            await asyncio.sleep(0.005)
        await desk.close()
        return record

    with opened(tmp_path / "data") as desk:
        record = asyncio.run(ended(desk))
        assert record.status == "refused"
        assert "the service ended" in record.message
        assert desk.cases == ()
        assert left(tmp_path / "data") == []


def test_only_the_latest_uploads_are_remembered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(upload_desk, "MAX_KEPT", 3)
    with opened(tmp_path / "data") as desk:
        for _ in range(6):
            with pytest.raises(QuotaError):
                asyncio.run(desk.receive(chunks(b"PK"), 2, sender(most=1)))
        assert len(desk.uploads) <= 4
        newest = desk.uploads[0]
        assert desk.upload(newest.upload) is newest
        assert desk.upload("u0") is None
