"""A small case that every run test can afford: water behind a dam in a sloping valley, 96 x 96 cells."""

from pathlib import Path

import numpy as np

from protocol import EditLine, EditType, Operation

CELLS = 96
DX = 10.0
OUTPUT_INTERVAL = 5.0


def write_dam_break(folder: Path, duration: float = 100.0, name: str = "dam-break") -> Path:
    """Write the case and give its folder."""
    folder.mkdir(parents=True, exist_ok=True)
    length = CELLS * DX
    y, x = np.mgrid[0:CELLS, 0:CELLS] * DX + 0.5 * DX
    bed = 0.02 * (length - y) + 60.0 * ((x - 0.5 * length) / (0.5 * length)) ** 2
    bed += 2.0 * np.sin(x / 130.0) * np.cos(y / 170.0)
    depth = np.where(y < 0.25 * length, np.maximum(0.0, 0.018 * length + 20.0 - bed), 0.0)
    np.savez(folder / "terrain.npz", bed=bed.astype(np.float32), depth=depth.astype(np.float32))
    (folder / "case.toml").write_text(
        f"""
[case]
name = "{name}"
title = "A dam break for tests"
hypothetical = true
crs = "local"
vertical_datum = "local"
source = "made by the tests"
licence = "Apache-2.0"

[terrain]
dem = "terrain.npz"
key = "bed"
cell_size = {DX}

[roughness]
manning_n = 0.035

[initial]
depth = "terrain.npz"
depth_key = "depth"

[[boundary]]
edge = "north"
kind = "open"

[run]
duration = {duration}
output_interval = {OUTPUT_INTERVAL}
""",
        encoding="utf-8",
    )
    return folder


def levee(name: str, y: float = 300.0, height: float = 15.0) -> EditLine:
    """A levee across the valley."""
    return EditLine(
        id=name,
        vertices=((50.0, y), (910.0, y)),
        width=30.0,
        operation=Operation.raise_,
        type=EditType.modulate,
        magnitude=height,
    )
