"""Write a case of one's own: a dam across a synthetic valley, for `fev-solver` and the viewer.

    python examples/synthetic_valley.py valley
    fev-solver check valley
    fev-solver run valley --out results

The valley falls 0.5 % to the east, winds a little, and is closed by a dam that is gone at time 0.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import rasterio
from rasterio.transform import from_origin

NROWS, NCOLS, DX = 120, 300, 10.0
X0, Y0 = 500_000.0, 5_400_000.0
DAM_X = X0 + 600.0

CASE = f"""\
# A dam across a synthetic valley; made by examples/synthetic_valley.py.

[case]
name = "valley"
title = "A dam across a synthetic valley"
hypothetical = true
crs = "EPSG:32632"
vertical_datum = "none, the valley is made up"
source = "examples/synthetic_valley.py"
licence = "Apache-2.0"

[terrain]
dem = "bed.tif"

[roughness]
manning_n = 0.035

# Still water at 115 m, left of the line that runs north along the dam, as far as it hangs together.
[[initial.level]]
level = 115.0
side_of_line = [[{DAM_X}, {Y0}], [{DAM_X}, {Y0 + NROWS * DX}]]
connected_to = [{DAM_X - 100.0}, {Y0 + 0.5 * NROWS * DX}]

[[boundary]]
edge = "east"
kind = "open"

[[gauge]]
id = "village"
at = [{X0 + 1500.0}, {Y0 + 0.5 * NROWS * DX}]

[[section]]
id = "dam"
line = [[{DAM_X}, {Y0 + NROWS * DX}], [{DAM_X}, {Y0}]]

[run]
duration = 600.0
output_interval = 10.0
"""


def valley() -> np.ndarray:
    """Bed elevation [m], row 0 in the south: a winding parabola that falls to the east."""
    x = (np.arange(NCOLS) + 0.5) * DX
    y = (np.arange(NROWS) + 0.5) * DX
    middle = 0.5 * NROWS * DX + 120.0 * np.sin(2.0 * np.pi * x / 1400.0)
    across = (y[:, None] - middle[None, :]) / 100.0
    return (110.0 - 0.005 * x[None, :] + np.minimum(2.0 * across**2, 40.0)).astype(np.float32)


def write(folder: Path) -> None:
    """Write bed.tif and case.toml into a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    with rasterio.open(
        folder / "bed.tif",
        "w",
        driver="GTiff",
        height=NROWS,
        width=NCOLS,
        count=1,
        dtype="float32",
        crs="EPSG:32632",
        transform=from_origin(X0, Y0 + NROWS * DX, DX, DX),
        compress="deflate",
    ) as image:
        image.write(valley()[::-1], 1)
    (folder / "case.toml").write_text(CASE, encoding="utf-8")


if __name__ == "__main__":
    target = Path(sys.argv[1] if len(sys.argv) > 1 else "valley")
    write(target)
    print(f"wrote {target / 'case.toml'}; try: fev-solver run {target} --out results")
