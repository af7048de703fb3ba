"""The real import process: what it does, and what becomes of one that dies, hangs or talks nonsense."""

import asyncio
import os
import signal
from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.uploads import importer
from solver_service.uploads.import_messages import Accepted, ImportLimits, Stage
from tests.solver_service.uploads.archives import tiny

LIMITS = ImportLimits(cells=5000, unpacked_bytes=50_000_000, probe_s=0.05)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    upload = tmp_path / "upload"
    upload.mkdir()
    (upload / "archive.zip").write_bytes(tiny(tmp_path))
    return upload


def imported(folder: Path, limits: ImportLimits = LIMITS) -> tuple[Accepted, list[Stage]]:
    stages: list[Stage] = []
    return asyncio.run(importer.import_case(folder, limits, stages.append)), stages


def test_the_process_imports_a_case_and_tells_its_stages(folder: Path) -> None:
    found, stages = imported(folder)

    assert found.summary.name == "tiny"
    assert [stage.stage for stage in stages][-2:] == ["reading", "trying"]
    assert (folder / "shelf" / "case" / "case.toml").stat().st_mode & 0o077 == 0


def test_what_the_process_refuses_is_told_without_the_places_of_the_machine(folder: Path) -> None:
    with pytest.raises(CaseError, match=r"case.toml: the grid has 960 cells") as refusal:
        imported(folder, ImportLimits(cells=100))
    assert str(folder) not in str(refusal.value)


def test_too_little_memory_is_told(folder: Path) -> None:
    with pytest.raises(CaseError, match=r"memory|its process ended"):
        imported(folder, ImportLimits(memory_bytes=300 << 20, probe_s=0.05))


def test_a_process_that_takes_too_long_is_ended(folder: Path) -> None:
    with pytest.raises(CaseError, match=r"takes more than 0.05 s"):
        imported(folder, ImportLimits(time_s=0.05))
    assert not _children()


@pytest.mark.parametrize(
    ("code", "sentence"),
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "ended by SIGKILL"),
        ("raise SystemExit(3)", "ended with status 3"),
        ("print('hello')", "said what no import says"),
        ("print('x' * 200_000)", "said what no import says"),
        ("""print('{"type":"stage","stage":"reading"}\\n' * 30_000)""", "said what no import says"),
        ("""print('{"type":"refused","sentence":"It is no case."}')""", "It is no case."),
    ],
)
def test_a_process_that_dies_or_talks_nonsense_is_a_refusal(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: str, sentence: str
) -> None:
    (tmp_path / "taken_over.py").write_text(code)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(importer, "MODULE", "taken_over")

    with pytest.raises(CaseError, match=sentence):
        imported(folder)
    assert not _children()


def test_an_import_that_is_cancelled_leaves_no_process(folder: Path) -> None:
    async def cancelled() -> None:
        task = asyncio.create_task(importer.import_case(folder, LIMITS, lambda stage: None))
        while not _children():
            await asyncio.sleep(0.01)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    asyncio.run(cancelled())
    assert not _children()


def test_an_import_process_that_is_killed_midway_is_a_refusal(folder: Path) -> None:
    async def killed() -> None:
        def kill(stage: Stage) -> None:
            for child in _children():
                os.kill(child, signal.SIGKILL)

        await importer.import_case(folder, LIMITS, kill)

    with pytest.raises(CaseError, match="ended by SIGKILL"):
        asyncio.run(killed())


def _children() -> list[int]:
    """Import processes of this process that live."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            words = (path / "cmdline").read_bytes().split(b"\0")
            parent = int((path / "stat").read_text().rsplit(")", 1)[1].split()[1])
        except (FileNotFoundError, ProcessLookupError):
            continue
        if parent == os.getpid() and importer.MODULE.encode() in words:
            found.append(int(path.name))
    return found
