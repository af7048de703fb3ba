import math

import numpy as np
import pytest

from viewer.render import hud_panels
from viewer.units import METRIC, US
from viewer.world import DEPTH_SCALE


def pixels(image) -> np.ndarray:
    return np.asarray(image)


@pytest.mark.parametrize(
    ("longest", "nice"), [(1.0, 1.0), (4.9, 2.0), (5.0, 5.0), (999.0, 500.0), (1234.0, 1000.0), (0.37, 0.2)]
)
def test_a_scale_bar_has_a_round_length(longest: float, nice: float) -> None:
    assert hud_panels.nice_length(longest) == pytest.approx(nice)


def test_the_scale_bar_is_as_long_as_it_says() -> None:
    image = pixels(hud_panels.scale_panel(10.0, 0.0, 1.0))
    white = (image[..., :3].min(axis=2) > 250) & (image[..., 3] > 250)
    longest_run = max(np.diff(np.flatnonzero(np.append(~row, True)), prepend=-1).max() - 1 for row in white)

    assert longest_run == pytest.approx(1000.0 / 10.0, abs=3)


def test_the_height_between_contour_lines_is_written_in_the_units_chosen() -> None:
    plain = pixels(hud_panels.scale_panel(10.0, 0.0, 1.0))
    ten, twenty = (pixels(hud_panels.scale_panel(10.0, 0.0, 1.0, METRIC, m)) for m in (10.0, 20.0))
    feet = pixels(hud_panels.scale_panel(10.0, 0.0, 1.0, US, 10.0))

    assert ten.shape[1] > plain.shape[1]
    assert not np.array_equal(ten, twenty)
    assert feet.shape != ten.shape or not np.array_equal(feet, ten)


def test_the_north_arrow_points_against_the_bearing() -> None:
    for bearing in (0.0, 90.0, 180.0, 270.0):
        image = pixels(hud_panels.scale_panel(10.0, bearing, 1.0)).astype(int)
        red = np.argwhere((image[..., 0] - image[..., 1] > 50) & (image[..., 3] > 250))
        centre = np.array([image.shape[0] / 2, image.shape[1] - 12 - 18])
        tip = red[np.linalg.norm(red - centre, axis=1).argmax()] - centre
        angle = math.radians(-bearing)
        assert tip @ [-math.cos(angle), math.sin(angle)] > 14.0


def test_the_legend_shows_every_class_with_the_deepest_on_top() -> None:
    image = pixels(hud_panels.legend_panel(DEPTH_SCALE, 1.0))
    rows = [
        np.argwhere((image[..., :3] == colour).all(axis=2))[:, 0].mean() for colour in DEPTH_SCALE.colours
    ]

    assert rows == sorted(rows, reverse=True)


def test_a_longer_text_makes_a_wider_panel_and_more_lines_a_higher_one() -> None:
    small = hud_panels.text_panel("title", "time", "a", 1.0)

    assert hud_panels.text_panel("a title that is much longer", "time", "a", 1.0).width > small.width
    assert hud_panels.text_panel("title", "time", "a\nb\nc", 1.0).height > small.height


def test_an_alert_is_red_and_a_remark_amber() -> None:
    alert = pixels(hud_panels.banner_panel("lost", 1.0, alert=True))[3, 30]
    remark = pixels(hud_panels.banner_panel("hypothetical", 1.0, alert=False))[3, 30]

    assert alert[0] > 2 * alert[1]
    assert remark[1] > 0.6 * remark[0] > 2 * remark[2]


@pytest.mark.parametrize("scale", [0.6, 1.0, 2.5])
def test_panels_grow_with_the_picture(scale: float) -> None:
    assert hud_panels.depth_ramp_panel(scale).width == pytest.approx(252 * scale, rel=0.05)


def test_a_banner_of_two_lines_is_taller_and_as_wide_as_its_longer_line() -> None:
    one, two = (
        hud_panels.banner_panel(text, 1.0, True) for text in ("connection lost", "connection lost\nold")
    )

    assert two.width == one.width
    assert two.height > 1.5 * one.height


def test_the_legend_of_a_comparison_names_the_other_run_and_has_a_box_for_each_colour() -> None:
    panel = np.asarray(hud_panels.difference_panel("run jacksboro", 1.0))
    longer = hud_panels.difference_panel("a run with a name that takes more room than the colours", 1.0)

    for _, colour in hud_panels.DIFFERENCES:
        assert (panel[..., :3] == colour).all(axis=2).sum() > 200
    assert longer.width > panel.shape[1]


def test_legends_are_written_in_the_units_asked_for() -> None:
    for make in (
        lambda units: hud_panels.depth_ramp_panel(1.0, units),
        lambda units: hud_panels.difference_panel("run x", 1.0, units),
    ):
        assert make(METRIC).tobytes() != make(US).tobytes()
        assert make(METRIC).tobytes() == make(METRIC).tobytes()


def test_a_pin_points_at_the_middle_of_its_lower_border_with_or_without_a_name() -> None:
    for name in ("town", ""):
        panel = pixels(hud_panels.mark_panel(name, False, 1.0))
        assert panel.shape[1] % 2 == 1
        tip = np.flatnonzero(panel[-1, :, 3])
        assert abs(tip.mean() - panel.shape[1] // 2) <= 1.0
    named, bare, chosen = (
        hud_panels.mark_panel(*says, 1.0) for says in (("town", False), ("", False), ("town", True))
    )
    assert named.height > bare.height
    assert named.tobytes() != chosen.tobytes()
