import math
from pathlib import Path

import numpy as np
import pytest

from viewer.app.picture_file import checked_order, picture_size, save_png
from viewer.commands import CommandError, SavePicture


@pytest.mark.parametrize(
    ("width", "height", "size"),
    [
        (None, None, (160, 90)),
        (1920.0, 1080.0, (1920, 1080)),
        (320.0, None, (320, 180)),
        (None, 180.0, (320, 180)),
        (None, 8192.0, (8192, 8192)),
    ],
)
def test_one_side_alone_keeps_the_shape_shown(
    width: float | None, height: float | None, size: tuple[int, int]
) -> None:
    order = checked_order(SavePicture("a.png", width, height))

    assert picture_size(order, (160, 90)) == size


@pytest.mark.parametrize("side", [63.0, 8193.0, 100.5, math.inf, -1.0])
def test_a_senseless_size_is_refused(side: float) -> None:
    with pytest.raises(CommandError, match="64 to 8192"):
        checked_order(SavePicture("a.png", width=side))
    with pytest.raises(CommandError, match=r"SavePicture\.height"):
        checked_order(SavePicture("a.png", height=side))


def test_a_half_written_picture_never_bears_the_name(tmp_path: Path) -> None:
    with pytest.raises((TypeError, ValueError)):
        save_png(tmp_path / "a.png", np.zeros((4, 4, 7), dtype=np.uint8))

    assert list(tmp_path.iterdir()) == []
