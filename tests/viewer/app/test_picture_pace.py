import pytest

from viewer.app.picture_pace import FAST_MS, PATIENCE, SCALES, SLOW_MS, PicturePace


def drawn(pace: PicturePace, full_ms: float, pictures: int) -> list[float]:
    """The scales of pictures whose time goes with their pixels."""
    scales = []
    for _ in range(pictures):
        scales.append(pace.scale)
        pace.note(full_ms * pace.scale**2)
    return scales


def test_slow_pictures_become_coarser_until_they_keep_pace() -> None:
    pace = PicturePace()
    drawn(pace, 150.0, 100)
    assert pace.scale == 0.75
    assert 150.0 * pace.scale**2 < SLOW_MS


def test_the_coarsest_scale_is_the_end() -> None:
    pace = PicturePace()
    drawn(pace, 5000.0, 100)
    assert pace.scale == SCALES[-1]


def test_fast_pictures_become_finer_again() -> None:
    pace = PicturePace(SCALES[-1])
    drawn(pace, 20.0, 200)
    assert pace.scale == 1.0


def test_a_single_slow_picture_changes_nothing() -> None:
    pace = PicturePace()
    for ms in (30.0, 30.0, 900.0, 30.0, 900.0, 900.0, 30.0):
        pace.note(ms)
    assert pace.scale == 1.0


def test_a_scale_that_was_too_slow_is_left_alone_for_a_while() -> None:
    pace = PicturePace(0.85)
    for _ in range(3):
        pace.note(SLOW_MS + 1.0)
    assert pace.scale == 0.75
    for _ in range(PATIENCE - 1):
        pace.note(FAST_MS - 1.0)
        assert pace.scale == 0.75
    pace.note(FAST_MS - 1.0)
    assert pace.scale == 0.85


def test_only_scales_of_the_list_are_taken() -> None:
    with pytest.raises(ValueError, match="not in"):
        PicturePace(0.5)
