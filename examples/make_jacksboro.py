"""Make the terrain of the embedded case `jacksboro` from the elevation model in matplotlib's sample data.

    python examples/make_jacksboro.py [OUTPUT.npz]

The source is a USGS digital elevation model (3 arc-seconds, whole metres, public domain) of the Cumberland
Mountains around the Jacksboro fault, Tennessee. Two things about it must be known:

- Its rows run from north to south, and its `ymax` = 36.44625 is the northern edge. Its `ymin` = 36.73292 has
  the sign of the height wrong: the southern edge is 36.15958. So placed, the gap of Big Creek is at
  LaFollette and the flat water in the south-east is Norris Lake.
- Cells of 90 m close narrow creeks. From two places, the gap of Big Creek and the western foot of the hill
  before it, the creek is cut along its lowest way to the edge of the model, as hydrologists do before routing
  water over such a model; the cuts are 21 m deep at most.

The result is resampled (cubic) to 30 m in UTM zone 16N and stored as differences of decimetres.
"""

from __future__ import annotations

import heapq
import sys
from pathlib import Path

import numpy as np
from matplotlib import cbook
from numpy.typing import NDArray
from pyproj import Transformer
from rasterio.transform import from_origin
from rasterio.warp import Resampling, reproject

NORTH, WEST, STEP = 36.44625, -84.41375, 1.0 / 1200.0
"""Northern and western edge and cell size of the source [degrees]."""
CRS = "EPSG:32616"
DX = 30.0
"""Cell size of the case [m]."""
XMIN, YMIN, XMAX, YMAX = 740_010.0, 4_014_000.0, 761_880.0, 4_036_530.0
"""Edges of the case [m]."""
CREEKS = ((757_550.0, 4_031_150.0), (757_000.0, 4_028_600.0))
"""Where the creeks begin that are cut: in the gap with the hypothetical dam, and west of the hill [m]."""
DEFAULT_OUTPUT = Path(__file__).parents[1] / "solver_service" / "cases" / "jacksboro" / "terrain.npz"


def cut_creek(z: NDArray[np.float64], row: int, col: int) -> NDArray[np.float64]:
    """Lower a model so that the way with the lowest highest point from a cell to the edge never rises.

    A flood from the edge inwards, lowest cell first, reaches each cell by that way (Barnes et al. 2014,
    Computers & Geosciences 62, 117-127: priority flood).
    """
    rows, cols = z.shape
    reached_from = np.full(z.shape, -2)
    edge = [(r, c) for r in range(rows) for c in range(cols) if r in (0, rows - 1) or c in (0, cols - 1)]
    front = [(z[cell], *cell) for cell in edge]
    for cell in edge:
        reached_from[cell] = -1
    heapq.heapify(front)
    while front:
        level, r, c = heapq.heappop(front)
        for near in ((r + dr, c + dc) for dr in (-1, 0, 1) for dc in (-1, 0, 1)):
            if 0 <= near[0] < rows and 0 <= near[1] < cols and reached_from[near] == -2:
                reached_from[near] = r * cols + c
                heapq.heappush(front, (max(level, z[near]), *near))
    cut = z.copy()
    lowest = np.inf
    here = row * cols + col
    while here >= 0:
        cell = divmod(here, cols)
        lowest = min(lowest, z[cell])
        cut[cell] = lowest
        here = int(reached_from[cell])
    return cut


def make() -> NDArray[np.int16]:
    """Elevation in decimetres, row 0 in the south, on the cells of the case."""
    source = cbook.get_sample_data("jacksboro_fault_dem.npz")["elevation"].astype(np.float64)
    to_degrees = Transformer.from_crs(CRS, "EPSG:4326", always_xy=True)
    for start in CREEKS:
        longitude, latitude = to_degrees.transform(*start)
        source = cut_creek(source, int((NORTH - latitude) / STEP), int((longitude - WEST) / STEP))
    shape = (round((YMAX - YMIN) / DX), round((XMAX - XMIN) / DX))
    resampled = np.full(shape, np.nan, np.float32)
    reproject(
        source.astype(np.float32),
        resampled,
        src_transform=from_origin(WEST, NORTH, STEP, STEP),
        src_crs="EPSG:4326",
        dst_transform=from_origin(XMIN, YMAX, DX, DX),
        dst_crs=CRS,
        dst_nodata=np.nan,
        resampling=Resampling.cubic,
    )
    if np.isnan(resampled).any():
        raise SystemExit("The case reaches beyond the elevation model.")
    return np.round(resampled[::-1] * 10.0).astype(np.int16)


def differences(values: NDArray[np.int16]) -> NDArray[np.int16]:
    """Differences along both axes: small numbers, which compress well; two running sums undo them."""
    return np.diff(np.diff(values, axis=0, prepend=np.int16(0)), axis=1, prepend=np.int16(0))


def write(path: Path) -> None:
    """Write the archive that `[terrain]` of the case reads."""
    np.savez_compressed(
        path,
        bed=differences(make()),
        bed_differences=np.int8(1),
        bed_scale=0.1,
        dx=DX,
        x0=XMIN,
        y0=YMIN,
    )


if __name__ == "__main__":
    output = Path(sys.argv[1]) if len(sys.argv) > 1 else DEFAULT_OUTPUT
    write(output)
    print(f"{output}: {output.stat().st_size} bytes")
