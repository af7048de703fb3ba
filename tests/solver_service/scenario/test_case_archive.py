"""What an archive may do to whoever unpacks it: nothing, and it is told why."""

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.scenario.case_archive import ArchiveLimits, unpack
from tests.solver_service.scenario import hostile_zips


@pytest.fixture
def target(tmp_path: Path) -> Path:
    folder = tmp_path / "unpacked"
    folder.mkdir()
    return folder


def test_a_plain_archive_is_unpacked_byte_for_byte_and_tells_how_far_it_is(
    tmp_path: Path, target: Path
) -> None:
    entries = {"case.toml": b"x = 1", "maps/bed.asc": bytes(range(256)) * 8000}
    told: list[tuple[int, int]] = []

    unpack(hostile_zips.plain(tmp_path / "a.zip", entries), target, on_progress=lambda *at: told.append(at))

    found = {str(p.relative_to(target)): p.read_bytes() for p in target.rglob("*") if p.is_file()}
    assert found == entries
    total = sum(map(len, entries.values()))
    assert told[-1] == (total, total)
    assert len(told) > 2


@pytest.mark.parametrize(
    ("made", "sentence"),
    [
        (hostile_zips.bomb, r"'bed.asc' unpacks to 80000000 bytes, over 1000 times"),
        (hostile_zips.many_bombs, r"unpacks to \d+ bytes; up to 20000000 are allowed"),
        (hostile_zips.liar, r"cannot be unpacked: Bad CRC-32|'bed.asc' is larger than it says"),
        (hostile_zips.link, r"the link or device 'bed.asc'"),
        (lambda path: hostile_zips.link(path, 0o020666), r"the link or device 'bed.asc'"),
        (hostile_zips.twice, r"'Case.TOML' twice"),
        (hostile_zips.overlapping, r"overlaps what comes after it"),
        (hostile_zips.million_entries, r"a directory of 47000000 bytes; up to 4194304"),
        (hostile_zips.many_entries, r"holds 10001 files; up to 10000 are allowed"),
        (hostile_zips.truncated, r"its end is missing|not stand before its end"),
        (hostile_zips.encrypted, r"'case.toml' is encrypted"),
        (hostile_zips.hidden_name, r"printable characters"),
        (hostile_zips.prefixed, r"does not stand before its end"),
        (hostile_zips.bzip2, r"packed by method 12; 0 \(stored\) and 8 \(deflated\) are allowed"),
    ],
)
def test_a_hostile_archive_is_refused_in_words_with_little_memory(
    tmp_path: Path, target: Path, made: Callable[[Path], Path], sentence: str
) -> None:
    path = made(tmp_path / "a.zip")
    tracemalloc.start()
    try:
        with pytest.raises(CaseError, match=sentence) as refusal:
            unpack(path, target, ArchiveLimits(unpacked_bytes=20_000_000 if "many" in str(made) else 4 << 30))
        assert tracemalloc.get_traced_memory()[1] < 40_000_000
    finally:
        tracemalloc.stop()
    assert str(refusal.value).startswith("a.zip: ")
    assert str(tmp_path) not in str(refusal.value)
    assert sum(p.stat().st_size for p in target.rglob("*")) < 1000


@pytest.mark.parametrize(
    "name", ["../evil", "/evil", "a/../../evil", "..\\evil", "C:evil", "evil ", "evil.", "a\nb", "x" * 201]
)
def test_a_name_that_leads_elsewhere_is_refused_before_anything_is_written(
    tmp_path: Path, target: Path, name: str
) -> None:
    path = hostile_zips.written(tmp_path / "a.zip", [("case.toml", b"", None), (name, b"evil", None)])

    with pytest.raises(CaseError, match=r"leaves the archive|names of up to 200 printable"):
        unpack(path, target)
    assert not list(target.iterdir())


def test_a_deep_folder_is_refused(tmp_path: Path, target: Path) -> None:
    path = hostile_zips.plain(tmp_path / "a.zip", {"/".join("abcdefgh") + "/bed.asc": b"1"})

    with pytest.raises(CaseError, match="in up to 7 folders"):
        unpack(path, target)


def test_an_archive_within_an_archive_stays_a_file(tmp_path: Path, target: Path) -> None:
    unpack(hostile_zips.quine(tmp_path / "a.zip"), target)

    assert [p.name for p in target.rglob("*")] == ["r.zip"]


def test_what_is_no_archive_is_refused(tmp_path: Path, target: Path) -> None:
    (tmp_path / "a.zip").write_bytes(b"GIF89a" * 100)
    (tmp_path / "b.zip").write_bytes(b"")

    for name in ("a.zip", "b.zip"):
        with pytest.raises(CaseError, match=f"{name}: is no zip archive"):
            unpack(tmp_path / name, target)
