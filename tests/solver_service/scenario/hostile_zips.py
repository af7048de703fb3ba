"""Archives that were made to harm: each function writes one and gives its path."""

import struct
import zipfile
import zlib
from pathlib import Path

CASE = b"[case]\nname = 'harm'\n"


def plain(path: Path, entries: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)
    return path


def bomb(path: Path) -> Path:
    """80 MB of zeros in 80 kB."""
    return plain(path, {"case.toml": CASE, "bed.asc": bytes(80_000_000)})


def many_bombs(path: Path, count: int = 50) -> Path:
    """Each file within the allowed ratio, and gigabytes together as their sizes say."""
    packed = zlib.compressobj(9, zlib.DEFLATED, -15)
    data = packed.compress(bytes(900_000)) + packed.flush()
    entries = [(f"{number}.asc", data, 90 * len(data) * 10) for number in range(count)]
    return written(path, [("case.toml", CASE, None), *entries])


def liar(path: Path) -> Path:
    """A file that says 10 bytes and unpacks to a megabyte."""
    packed = zlib.compressobj(9, zlib.DEFLATED, -15)
    data = packed.compress(bytes(1_000_000)) + packed.flush()
    return written(path, [("case.toml", CASE, None), ("bed.asc", data, 10)])


def link(path: Path, mode: int = 0o120777) -> Path:
    entry = zipfile.ZipInfo("bed.asc")
    entry.external_attr = mode << 16
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("case.toml", CASE)
        archive.writestr(entry, "/etc/passwd")
    return path


def twice(path: Path) -> Path:
    return written(path, [("case.toml", CASE, None), ("Case.TOML", CASE, None)])


def overlapping(path: Path) -> Path:
    """Every entry is the same bytes: a thousand files for the price of one."""
    whole = plain(path, {"case.toml": CASE, "bed.asc": bytes(500_000)})
    data = bytearray(whole.read_bytes())
    end = data.rindex(b"PK\5\6")
    start = struct.unpack_from("<L", data, end + 16)[0]
    second = data.index(b"PK\1\2", start + 4)
    entry = bytes(data[second:end])
    copies = b"".join(entry.replace(b"bed.asc", b"b%02d.asc" % number) for number in range(50))
    local = bytes(data[:start])
    directory = bytes(data[start:second]) + copies
    tail = struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, 51, 51, len(directory), start, 0)
    path.write_bytes(local + directory + tail)
    return path


def million_entries(path: Path) -> Path:
    """A directory of 10^6 entries."""
    entry = struct.pack("<4s6H3L5H2L", b"PK\1\2", 20, 20, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0) + b"a"
    count = 1_000_000
    tail = struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, 1, 1, len(entry) * count, 0, 0)
    path.write_bytes(entry * count + tail)
    return path


def many_entries(path: Path, count: int = 10_001) -> Path:
    return written(path, [(f"{number}", b"", None) for number in range(count)])


def quine(path: Path) -> Path:
    """An archive that holds itself, as far down as one likes to look."""
    inner = plain(path.with_name("inner.zip"), {"case.toml": CASE})
    for _ in range(4):
        inner = plain(path.with_name(f"around-{inner.name}"), {"r.zip": inner.read_bytes()})
    inner.rename(path)
    return path


def truncated(path: Path) -> Path:
    whole = plain(path, {"case.toml": CASE, "bed.asc": bytes(range(256)) * 40})
    path.write_bytes(whole.read_bytes()[:-30])
    return path


def encrypted(path: Path) -> Path:
    whole = plain(path, {"case.toml": CASE})
    data = bytearray(whole.read_bytes())
    data[6] |= 1
    data[data.index(b"PK\1\2") + 8] |= 1
    path.write_bytes(data)
    return path


def hidden_name(path: Path) -> Path:
    """A name that some readers end at the NUL."""
    return written(path, [("case.toml", CASE, None), ("bed.asc\0.vrt", b"1", None)])


def prefixed(path: Path) -> Path:
    """Something else before the archive: two readers may see two archives."""
    whole = plain(path, {"case.toml": CASE})
    path.write_bytes(b"MZ" * 100 + whole.read_bytes())
    return path


def bzip2(path: Path) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_BZIP2) as archive:
        archive.writestr("case.toml", CASE * 100)
    return path


def written(path: Path, entries: list[tuple[str, bytes, int | None]]) -> Path:
    """An archive byte by byte: name, packed data, and the size it says (None: stored, the true one)."""
    local, directory = b"", b""
    for name, data, size in entries:
        method, said = (0, len(data)) if size is None else (8, size)
        crc = zlib.crc32(data) if size is None else 0
        text = name.encode()
        facts = struct.pack("<5H3L2H", 20, 0, method, 0, 0, crc, len(data), said, len(text), 0)
        directory += b"PK\1\2" + struct.pack("<H", 20) + facts
        directory += struct.pack("<3H2L", 0, 0, 0, 0, len(local)) + text
        local += b"PK\3\4" + facts + text + data
    count = len(entries)
    tail = struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, count, count, len(directory), len(local), 0)
    path.write_bytes(local + directory + tail)
    return path
