"""The reference page is up to date, and enough to read a frame without this package."""

import struct
import zlib
from pathlib import Path

import msgpack
import numpy as np
import pytest
import zstandard

from protocol import BlockLayout, Credit, FrameEncoder, operation, pack, quantise_depth
from protocol.reference import main, renew, sections
from tests.protocol.examples import CLIENT_KINDS, SERVER_KINDS

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference" / "protocol.md"


def test_the_page_is_up_to_date() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert renew(page) == page, "python -m protocol.reference docs/reference/protocol.md"


def test_every_message_stands_on_the_page_with_a_meaning_for_each_field() -> None:
    parts = sections()
    for kinds, name in ((CLIENT_KINDS, "client messages"), (SERVER_KINDS, "server messages")):
        for kind in kinds:
            assert f"### `{operation(kind)}`\n" in parts[name]
    rows = [line for part in parts.values() for line in part.splitlines() if line.startswith("| `")]
    assert rows
    assert not [row for row in rows if row.endswith("|  |")]


def test_a_page_without_a_place_for_a_part_is_refused() -> None:
    with pytest.raises(ValueError, match="client messages"):
        renew("# Protocol\n")


def test_a_page_is_renewed_in_its_file(tmp_path: Path) -> None:
    page = PAGE.read_text(encoding="utf-8")
    old = tmp_path / "protocol.md"
    old.write_text(page.replace("| `revision` |", "| `version` |"), encoding="utf-8")
    main(old)
    assert old.read_text(encoding="utf-8") == page


def test_the_bytes_on_the_page_are_those_of_a_credit() -> None:
    assert pack(Credit(1)).hex(" ") in PAGE.read_text(encoding="utf-8")


def read_numbers(raw: bytes, codec: str) -> tuple[int, ...]:
    """The numbers of a payload, by the page alone."""
    if codec == "u2":
        return struct.unpack(f"<{len(raw) // 2}H", raw)
    numbers, x, n = [], 0, len(raw) // 2
    for low, high in zip(raw[:n], raw[n:], strict=True):
        z = low + 256 * high
        x = (x + (z // 2 if z % 2 == 0 else -(z + 1) // 2)) % 65536
        numbers.append(x)
    return tuple(numbers)


def read_frame(data: bytes, nrows: int, ncols: int, keys: dict[int, list[int]]) -> list[int]:
    """All q of a frame, by the page alone: no NumPy, nothing of this package."""
    fields = msgpack.unpackb(data)
    block_rows, block_cols = (max(1, -(-(n - 1) // 32)) for n in (nrows, ncols))
    packed = fields["states"]
    states = [packed[k // 4] >> 2 * (k % 4) & 3 for k in range(block_rows * block_cols)]
    raw = zstandard.ZstdDecompressor().decompress(fields["payload"])
    assert len(raw) == fields["raw_size"]
    numbers = read_numbers(raw, fields.get("codec", "u2"))
    assert zlib.crc32(struct.pack(f"<{len(numbers)}H", *numbers)) == fields["checksum"]
    values = iter(numbers)
    key = keys.get(fields["key_index"]) if fields["key_index"] != fields["index"] else None
    depths = []
    for row in range(nrows):
        for col in range(ncols):
            owner = min(row // 32, block_rows - 1) * block_cols + min(col // 32, block_cols - 1)
            q = 0
            if states[owner] != 0:
                q = next(values)
                if key is not None:
                    q = (q + key[row * ncols + col]) % 65536
            depths.append(q)
    if fields["key_index"] == fields["index"]:
        keys[fields["index"]] = depths
    return depths


def test_frames_can_be_read_by_the_page_alone() -> None:
    encoder = FrameEncoder(BlockLayout(70, 99), group=3)
    row, col = np.mgrid[0:70, 0:99]
    keys: dict[int, list[int]] = {}
    for index in range(6):
        h = np.maximum(2.0 + index - 0.05 * row - 0.03 * (col - 10.0 * index), 0.0).astype(np.float32)
        data = encoder.encode("r", index, 10.0 * index, 0, h)
        assert read_frame(data, 70, 99, keys) == quantise_depth(h, 0.001, 1e-3).ravel().tolist()
