import moderngl
import numpy as np
import pytest

from viewer.errors import TerrainDataError
from viewer.render import DepthDifference
from viewer.render.difference_texture import DIFFERENCE_RANGE_M, DifferenceTexture, packed_difference

pytestmark = pytest.mark.gl


def test_no_difference_is_the_middle_and_the_range_fills_the_byte() -> None:
    shares = np.array([[0.0, 0.5, 1.0, -1.0, 99.0]], np.float32)

    assert packed_difference(DIFFERENCE_RANGE_M * shares).tolist() == [[128, 192, 255, 1, 255]]


def test_it_uploads_what_is_new_and_refuses_another_shape(ctx: moderngl.Context) -> None:
    texture = DifferenceTexture(ctx, (5, 7))
    metres = np.linspace(-1.0, 1.0, 35, dtype=np.float32).reshape(5, 7)
    texture.follow(DepthDifference("a", metres, "run"))
    read = np.frombuffer(texture._texture.read(alignment=1), np.uint8).reshape(5, 7)

    assert np.array_equal(read, packed_difference(metres))
    with pytest.raises(TerrainDataError, match="shape"):
        texture.follow(DepthDifference("b", metres[:4], "run"))
    texture.release()
