"""Files that were damaged on their way: a raster or one sentence, for every format."""

import gzip
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import rasterio
from rasterio.transform import from_origin

from solver_service.errors import TerrainError
from solver_service.terrain import Raster, read_dem
from tests.solver_service.selafin_file import selafin_bytes

TRIALS = 60
BED = (100.0 + np.arange(35 * 41, dtype=np.float32)).reshape(35, 41)


def gdal_file(path: Path, driver: str) -> None:
    options = (
        {"compress": "deflate", "tiled": True, "blockxsize": 16, "blockysize": 16}
        if driver == "GTiff"
        else {}
    )
    with rasterio.open(
        path,
        "w",
        driver=driver,
        height=35,
        width=41,
        count=1,
        dtype="float32",
        crs="EPSG:32632",
        transform=from_origin(5e5, 5e6, 10.0, 10.0),
        **options,
    ) as file:
        file.write(BED, 1)


def ascii_grid(path: Path) -> None:
    rows = "\n".join(" ".join(map(str, row)) for row in BED.tolist())
    path.write_text(f"ncols 41\nnrows 35\nxllcorner 0\nyllcorner 0\ncellsize 10\n{rows}\n")


def srtm_archive(path: Path) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("N49E011.hgt", np.full((1201, 1201), 300, ">i2").tobytes())


WRITERS: dict[str, Callable[[Path], None]] = {
    ".tif": lambda path: gdal_file(path, "GTiff"),
    ".img": lambda path: gdal_file(path, "HFA"),
    ".asc": ascii_grid,
    ".hgt.zip": srtm_archive,
    ".slf": lambda path: path.write_bytes(selafin_bytes()) and None,
    ".slf.gz": lambda path: path.write_bytes(gzip.compress(selafin_bytes())) and None,
    ".npz": lambda path: np.savez_compressed(path, bed=BED, dx=10.0),
}


def is_refused(path: Path) -> bool:
    """Whether a file is refused in one sentence; anything but a raster or that is let through to the test."""
    refusal = ""
    try:
        with np.errstate(all="ignore"):
            assert read_dem(path, key="bed", cell_size=10.0).values.ndim == 2
    except TerrainError as error:
        refusal = str(error)
    assert "\n" not in refusal
    return bool(refusal)


# Where GDAL cites damaged bytes in a message, the log of rasterio cannot decode it and says so aside.
@pytest.mark.qt_no_exception_capture
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("suffix", sorted(WRITERS))
def test_a_damaged_file_is_a_raster_or_one_sentence(
    tmp_path: Path, rng: np.random.Generator, suffix: str
) -> None:
    path = tmp_path / f"N49E011{suffix}"
    WRITERS[suffix](path)
    assert isinstance(read_dem(path, key="bed", cell_size=10.0), Raster)
    whole = path.read_bytes()
    refused = 0
    for trial in range(TRIALS):
        damaged = bytearray(whole)
        if trial % 3 == 0:
            del damaged[rng.integers(len(damaged)) :]
        else:
            # Headers stand at the beginning or the end: half of the hits go there.
            reach = len(damaged) if trial % 2 else min(400, len(damaged))
            for _ in range(rng.integers(1, 12)):
                place = int(rng.integers(reach))
                damaged[-place if rng.random() < 0.3 else place] = rng.integers(256)
        path.write_bytes(damaged)
        refused += is_refused(path)

    assert refused > 0
