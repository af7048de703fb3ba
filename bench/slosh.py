"""A case for the benches of the stream: a lake over a third and more of a valley that sloshes for ever.

Every frame differs from the one before, and a step costs the same at all times.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

CELL_SIZE = 10.0


def write_slosh_case(folder: Path, nrows: int, ncols: int, duration: float, output_interval: float) -> Path:
    """Write the case.

    Args:
        folder: where to; it must not exist.
        nrows: cells south to north.
        ncols: cells west to east.
        duration: of a run [s].
        output_interval: between frames [s].

    Returns:
        The folder.
    """
    folder.mkdir()
    dx = CELL_SIZE
    y, x = np.mgrid[0:nrows, 0:ncols] * dx
    valley = 40.0 * np.abs(x / (ncols * dx) - 0.5) * 2.0 + 3.0 * np.sin(x / 310.0) * np.cos(y / 270.0)
    tilt = 4.0 * (y / (nrows * dx) - 0.5)
    depth = np.maximum(0.0, 15.2 + tilt - valley)
    np.savez(folder / "terrain.npz", bed=valley.astype(np.float32), depth=depth.astype(np.float32))
    (folder / "case.toml").write_text(
        f"""
[case]
name = "slosh"
title = "A lake that sloshes"
hypothetical = true
crs = "local"
source = "made by the bench"
licence = "Apache-2.0"
[terrain]
dem = "terrain.npz"
key = "bed"
cell_size = {dx}
[roughness]
manning_n = 0.03
[initial]
depth = "terrain.npz"
depth_key = "depth"
[run]
duration = {duration}
output_interval = {output_interval}
""",
        encoding="utf-8",
    )
    return folder
