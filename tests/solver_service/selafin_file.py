"""A SELAFIN file of a plane z = 10 + 0.1 x - 0.05 y over a rectangle, cut into triangles."""

import struct
from pathlib import Path

import numpy as np


def record(data: bytes) -> bytes:
    return struct.pack(">i", len(data)) + data + struct.pack(">i", len(data))


def plane(x, y):
    return 10.0 + 0.1 * np.asarray(x) - 0.05 * np.asarray(y)


def selafin_bytes(
    width: float = 100.0, height: float = 60.0, name: bytes = b"BOTTOM", corners: int = 3
) -> bytes:
    columns, rows = np.meshgrid(np.linspace(0.0, width, 7), np.linspace(0.0, height, 5))
    x, y = columns.ravel(), rows.ravel()
    triangles = []
    for j in range(4):
        for i in range(6):
            a = j * 7 + i + 1
            triangles += [(a, a + 1, a + 8), (a, a + 8, a + 7)]
    parts = [
        record(b"a plane".ljust(80)),
        record(struct.pack(">2i", 2, 0)),
        record(b"VELOCITY U".ljust(32)),
        record(name.ljust(32)),
        record(struct.pack(">10i", 1, 0, 0, 0, 0, 0, 0, 0, 0, 1)),
        record(struct.pack(">6i", 1959, 12, 2, 21, 14, 0)),
        record(struct.pack(">4i", len(triangles), x.size, corners, 1)),
        record(np.array(triangles, ">i4").tobytes()),
        record(np.zeros(x.size, ">i4").tobytes()),
        record(x.astype(">f4").tobytes()),
        record(y.astype(">f4").tobytes()),
        record(struct.pack(">f", 0.0)),
        record(np.zeros(x.size, ">f4").tobytes()),
        record(plane(x, y).astype(">f4").tobytes()),
    ]
    return b"".join(parts)


def write_selafin(path: Path, **options) -> Path:
    path.write_bytes(selafin_bytes(**options))
    return path
