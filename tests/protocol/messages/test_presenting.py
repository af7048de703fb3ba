import math

import pytest
from msgspec import structs

from protocol import InvalidMessage, PresentView, View, ViewPresented, pack, unpack_client

VIEW = View("r-1", 60.0, 100.0, 200.0, 500.0, 90.0, 30.0)


def test_a_view_stands_still_unless_it_says_otherwise() -> None:
    assert (VIEW.is_playing, VIEW.speed) == (False, 1.0)
    assert PresentView(1).view is None
    assert ViewPresented("c0ffee").view is None


@pytest.mark.parametrize(
    "change",
    [
        {"distance": 0.0},
        {"time": -1.0},
        {"azimuth": 361.0},
        {"elevation": math.nan},
        {"x": math.inf},
        {"speed": 0.0},
        {"run": "../r"},
    ],
)
def test_a_view_that_no_camera_can_have_is_refused(change: dict[str, object]) -> None:
    good = pack(PresentView(1, VIEW))
    assert unpack_client(good) == PresentView(1, VIEW)
    try:
        bad = pack(PresentView(1, structs.replace(VIEW, **change)))
    except ValueError:
        return  # not even made
    with pytest.raises(InvalidMessage):
        unpack_client(bad)
