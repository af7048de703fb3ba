"""A case small enough to be solved within a test: a dam across a sloping valley."""

import csv
from pathlib import Path

import numpy as np

ROWS, COLS, DX = 24, 40, 10.0
X0, Y0 = 1000.0, 2000.0

CASE = """
[case]
name = "tiny"
title = "A dam in a valley"
hypothetical = true
crs = "local"
vertical_datum = "the floor"
source = "made up"
licence = "public domain"

[terrain]
dem = "bed.npz"
key = "bed"

[roughness]
manning_n = 0.03

[[initial.level]]
level = 306.0
polygon = [[1000.0, 2000.0], [1100.0, 2000.0], [1100.0, 2240.0], [1000.0, 2240.0]]

[[boundary]]
edge = "east"
kind = "open"

[run]
duration = 20.0
output_interval = 5.0
gauge_interval = 1.0
"""

GAUGES = """
[[gauge]]
id = "upper"
at = [1055.0, 2125.0]

[[gauge]]
id = "lower"
at = [1155.0, 2125.0]

[[section]]
id = "dam"
line = [[1100.0, 2240.0], [1100.0, 2000.0]]
"""


def valley() -> np.ndarray:
    """Bed [m], row 0 in the south: falls to the east, rises to both sides, near 300 m."""
    cols, rows = np.meshgrid(np.arange(COLS), np.arange(ROWS))
    return (303.0 - 0.05 * cols + 0.02 * (rows - 0.5 * (ROWS - 1)) ** 2).astype(np.float32)


def rows_of(table: Path) -> list[dict[str, str]]:
    """Rows of a CSV file by its header."""
    with table.open(newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def write_bed(folder: Path, bed: np.ndarray | None = None) -> None:
    np.savez_compressed(folder / "bed.npz", bed=valley() if bed is None else bed, dx=DX, x0=X0, y0=Y0)


def write_case(folder: Path, text: str = CASE, bed: np.ndarray | None = None) -> Path:
    """Write the case into a folder, which is made, and return the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    write_bed(folder, bed)
    (folder / "case.toml").write_text(text, encoding="utf-8")
    return folder
