import zipfile
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import TerrainError
from solver_service.terrain.read_srtm import read_srtm


def tile(side: int = 1201) -> np.ndarray:
    """Metres, north first: 100 in the south-western corner, a void in the north-eastern one."""
    values = np.full((side, side), 500, ">i2")
    values[-1, 0] = 100
    values[0, -1] = -32768
    return values


def test_a_tile_is_point_registered_and_turned(tmp_path: Path) -> None:
    (tmp_path / "N49E011.hgt").write_bytes(tile().tobytes())

    raster = read_srtm(tmp_path / "N49E011.hgt")

    assert raster.shape == (1201, 1201)
    assert raster.values[0, 0] == 100.0
    assert np.isnan(raster.values[-1, -1])
    assert raster.crs == "EPSG:4326"
    # The centre of the first cell is the corner of the degree itself.
    assert raster.x0 + 0.5 * raster.dx == pytest.approx(11.0, abs=1e-12)
    assert raster.y0 + 0.5 * raster.dy == pytest.approx(49.0, abs=1e-12)


def test_a_southern_western_tile_in_an_archive_is_read(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "S29W072.hgt.zip", "w") as archive:
        archive.writestr("S29W072.hgt", tile().tobytes())

    raster = read_srtm(tmp_path / "S29W072.hgt.zip")

    assert raster.y0 == pytest.approx(-29.0, abs=1e-3)
    assert raster.x0 == pytest.approx(-72.0, abs=1e-3)


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("valley.hgt", tile().tobytes(), "not named like an SRTM tile"),
        ("N49E011.hgt", tile(1200).tobytes(), "2880000 bytes; 1201 x 1201 or 3601 x 3601"),
        ("N49E011.hgt", b"", "0 bytes"),
        ("N49E011.hgt.zip", b"no archive", "cannot be read"),
    ],
)
def test_what_is_no_tile_is_refused(tmp_path: Path, name: str, data: bytes, message: str) -> None:
    (tmp_path / name).write_bytes(data)

    with pytest.raises(TerrainError, match=message):
        read_srtm(tmp_path / name)


def test_an_archive_that_would_swell_is_refused_unread(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "N49E011.hgt.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("N49E011.hgt", bytes(30_000_000))

    with pytest.raises(TerrainError, match="larger than any SRTM tile"):
        read_srtm(tmp_path / "N49E011.hgt.zip")
