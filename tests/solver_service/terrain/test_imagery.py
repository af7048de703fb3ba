"""Imagery of a case: laid where it lies, as fine as its source, within limits; the mask of walls."""

import io
import warnings
from pathlib import Path

import numpy as np
import pytest
import rasterio
from PIL import Image
from rasterio.transform import from_origin

from protocol import GridGeometry
from protocol.limits import MAX_IMAGERY_SIDE
from solver_service.errors import TerrainError
from solver_service.terrain import imagery
from solver_service.terrain.imagery import imagery_picture, walls_picture

GRID = GridGeometry(nrows=40, ncols=60, dx=10.0, x0=500_000.0, y0=5_000_000.0, crs="EPSG:32632")


def quarters(rows: int, cols: int) -> np.ndarray:
    """North-west red, north-east green, south-west blue, south-east white; rows from the north."""
    picture = np.zeros((rows, cols, 3), np.uint8)
    half_row, half_col = rows // 2, cols // 2
    picture[:half_row, :half_col, 0] = 255
    picture[:half_row, half_col:, 1] = 255
    picture[half_row:, :half_col, 2] = 255
    picture[half_row:, half_col:] = 255
    return picture


def save_tiff(
    path: Path, picture: np.ndarray, west: float, north: float, pixel: float, crs: str | None
) -> Path:
    rows, cols, bands = picture.shape
    with rasterio.open(
        path, "w", "GTiff", cols, rows, bands, crs, from_origin(west, north, pixel, pixel), picture.dtype.name
    ) as file:
        file.write(np.moveaxis(picture, 2, 0))
    return path


def opened(packed: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(packed), formats=["JPEG", "PNG"]))


def corners(picture: np.ndarray) -> list[tuple[int, ...]]:
    rows, cols = picture.shape[0] // 4, picture.shape[1] // 4
    places = [(rows, cols), (rows, 3 * cols), (3 * rows, cols), (3 * rows, 3 * cols)]
    return [tuple(round(v / 255.0) for v in picture[place]) for place in places]


QUARTERS = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)]


@pytest.mark.parametrize("name", ["ortho.png", "ortho.jpg"])
def test_a_plain_picture_covers_the_grid(tmp_path: Path, name: str) -> None:
    Image.fromarray(quarters(120, 180)).save(tmp_path / name, quality=95)
    picture = opened(imagery_picture(tmp_path / name, GRID))

    assert picture.shape == (120, 180, 3)
    assert corners(picture) == QUARTERS


def test_a_geotiff_is_laid_where_it_says_that_it_lies(tmp_path: Path) -> None:
    xmin, _, _, ymax = GRID.extent
    whole = save_tiff(tmp_path / "whole.tif", quarters(80, 120), xmin, ymax, 5.0, GRID.crs)
    picture = opened(imagery_picture(whole, GRID))
    assert picture.shape == (80, 120, 3)
    assert corners(picture) == QUARTERS

    # The same picture 300 m farther east covers the eastern half with its western one.
    moved = save_tiff(tmp_path / "moved.tif", quarters(80, 120), xmin + 300.0, ymax, 5.0, GRID.crs)
    picture = opened(imagery_picture(moved, GRID))
    assert corners(picture)[1::2] == [(1, 0, 0), (0, 0, 1)]
    assert abs(int(picture[20, 20, 0]) - 128) <= 2


def test_a_geotiff_of_another_system_is_reprojected(tmp_path: Path) -> None:
    from pyproj import Transformer

    xmin, ymin, xmax, ymax = GRID.extent
    back = Transformer.from_crs(GRID.crs, "EPSG:4326", always_xy=True)
    west, north = back.transform(xmin, ymax)
    east, south = back.transform(xmax, ymin)
    pixel = max(east - west, north - south) / 200.0
    rows, cols = round((north - south) / pixel), round((east - west) / pixel)
    path = save_tiff(tmp_path / "degrees.tif", quarters(rows, cols), west, north, pixel, "EPSG:4326")

    assert corners(opened(imagery_picture(path, GRID))) == QUARTERS


def test_a_large_source_is_averaged_down_to_the_limit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(imagery, "MAX_IMAGERY_SIDE", 64)
    stripes = np.zeros((200, 300, 3), np.uint8)
    stripes[:, ::2] = 255
    Image.fromarray(stripes).save(tmp_path / "fine.png")
    picture = opened(imagery_picture(tmp_path / "fine.png", GRID))

    assert picture.shape == (43, 64, 3)
    assert np.abs(picture.astype(int) - 128).max() < 40
    assert MAX_IMAGERY_SIDE == 4096


def test_grey_and_alpha_are_taken_as_colours(tmp_path: Path) -> None:
    Image.fromarray(np.full((20, 30), 77, np.uint8)).save(tmp_path / "grey.png")
    Image.fromarray(np.full((20, 30, 4), (10, 200, 30, 255), np.uint8)).save(tmp_path / "alpha.png")

    assert np.abs(opened(imagery_picture(tmp_path / "grey.png", GRID)).astype(int) - 77).max() <= 2
    assert (
        np.abs(opened(imagery_picture(tmp_path / "alpha.png", GRID)).astype(int) - (10, 200, 30)).max() <= 4
    )


def test_what_is_no_picture_or_lies_elsewhere_is_refused_in_one_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "list.vrt").write_text("<VRTDataset/>", encoding="ascii")
    with pytest.raises(TerrainError, match=r"does not begin like a TIFF, PNG or JPEG"):
        imagery_picture(tmp_path / "list.vrt", GRID)
    (tmp_path / "cut.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    with pytest.raises(TerrainError, match=r"cut\.png"):
        imagery_picture(tmp_path / "cut.png", GRID)
    with pytest.raises(TerrainError, match="cannot be read"):
        imagery_picture(tmp_path / "none.png", GRID)
    far = save_tiff(tmp_path / "far.tif", quarters(8, 8), 0.0, 0.0, 5.0, GRID.crs)
    with pytest.raises(TerrainError, match="nothing of the terrain"):
        imagery_picture(far, GRID)
    floats = save_tiff(tmp_path / "float.tif", np.zeros((8, 8, 3), np.float32), 5e5, 5e6, 5.0, GRID.crs)
    with pytest.raises(TerrainError, match="3 bands of float32; 1, 3 or 4 bands of uint8"):
        imagery_picture(floats, GRID)
    Image.fromarray(quarters(20, 30)).save(tmp_path / "large.png")
    monkeypatch.setattr(imagery, "MAX_SOURCE_PIXELS", 500)
    with pytest.raises(TerrainError, match="has 20 x 30 pixels; up to 500"):
        imagery_picture(tmp_path / "large.png", GRID)


def test_the_mask_of_walls_has_one_pixel_a_cell_and_north_on_top() -> None:
    wall = np.zeros((4, 6), np.bool_)
    wall[3, 1] = True
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        picture = opened(walls_picture(wall))

    assert picture.shape == (4, 6)
    assert picture[0, 1] == 255
    assert picture.sum() == 255
