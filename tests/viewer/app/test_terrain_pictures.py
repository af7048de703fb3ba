import io

import numpy as np
import pytest
from PIL import Image

import protocol
from protocol import GridGeometry
from viewer.app import terrain_pictures
from viewer.app.terrain_pictures import TerrainPictures, decode_imagery, decode_walls
from viewer.errors import TerrainDataError
from viewer.world import Heightfield

SHAPE = (20, 30)


def packed(pixels: np.ndarray, form: str) -> bytes:
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, form, quality=95)
    return file.getvalue()


def walls() -> tuple[np.ndarray, bytes]:
    mask = np.zeros(SHAPE, np.bool_)
    mask[:5, :7] = True
    return mask, packed(np.where(mask[::-1], np.uint8(255), np.uint8(0)), "PNG")


def test_pictures_come_with_the_south_first() -> None:
    mask, data = walls()
    assert np.array_equal(decode_walls(data, SHAPE), mask)
    ground = np.zeros((40, 60, 3), np.uint8)
    ground[:20, :, 0] = 255  # north
    picture = decode_imagery(packed(ground, "JPEG"))
    assert picture.shape == (40, 60, 3)
    assert picture[35, 30, 0] > 240
    assert picture[5, 30, 0] < 15


def test_pictures_may_come_before_and_after_the_ground() -> None:
    mask, data = walls()
    grid = GridGeometry(nrows=SHAPE[0], ncols=SHAPE[1], dx=1.0, x0=0.0, y0=0.0)
    ground = Heightfield(grid, np.where(mask, np.float32(50.0), np.float32(1.0)))
    pictures = TerrainPictures("r")
    pictures.take(protocol.ImageryReceived(1, "r", "walls", data), SHAPE)
    pictures.lay_on(ground)

    assert ground.z_max == 1.0
    assert ground.imagery is None
    pictures.take(
        protocol.ImageryReceived(2, "r", "imagery", packed(np.zeros((4, 6, 3), np.uint8), "JPEG")), SHAPE
    )
    assert ground.imagery is not None
    assert np.array_equal(ground.outside, mask)


def test_a_picture_that_is_none_or_too_large_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    jpeg = packed(np.zeros((40, 60, 3), np.uint8), "JPEG")
    _, png = walls()
    for wrong in (b"", b"GIF89a", jpeg[:50], png):
        with pytest.raises(TerrainDataError, match="JPEG"):
            decode_imagery(wrong)
    with pytest.raises(TerrainDataError, match=r"not \(21, 30\)"):
        decode_walls(png, (21, 30))
    with pytest.raises(TerrainDataError, match="up to 29 x 20 are allowed"):
        decode_walls(png, (20, 29))
    monkeypatch.setattr(terrain_pictures.protocol.limits, "MAX_IMAGERY_SIDE", 50)
    with pytest.raises(TerrainDataError, match="60 x 40 pixels; up to 50 x 50"):
        decode_imagery(jpeg)
