import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from viewer.render import Colouring, FrameInputs, HudText, PlaceMark, WaterFrame, WaterPair, hud_panels
from viewer.world import DEPTH_SCALE, Camera, Heightfield, WaterColour

pytestmark = pytest.mark.gl
CAMERA = Camera((0.0, 40.0, 0.0), 2000.0, 0.9, 0.6)


@pytest.fixture
def stage(hilly: Heightfield, make_stage: Callable):
    return make_stage(hilly, (640, 360))


def changed(stage, hud: HudText | None, **more: object) -> np.ndarray:
    plain = stage.draw(FrameInputs(CAMERA, **more)).astype(int)
    return (stage.draw(FrameInputs(CAMERA, hud=hud, **more)) != plain).any(axis=2)


def test_an_empty_hud_writes_nothing(stage) -> None:
    assert not changed(stage, HudText(legend=False, scale_and_north=False)).any()


def test_text_stands_in_the_upper_left(stage) -> None:
    where = changed(stage, HudText(title="case", time="00:20", legend=False, scale_and_north=False))

    assert where[:120, :200].any()
    assert not where[120:].any()
    assert not where[:, 320:].any()


def test_the_hypothetical_mark_stands_in_the_middle_of_the_upper_border(stage) -> None:
    where = changed(stage, HudText(is_hypothetical=True, legend=False, scale_and_north=False))
    columns = np.flatnonzero(where.any(axis=0))

    assert abs(columns.mean() - 320.0) < 3.0
    assert not where[60:].any()
    amber = stage.draw(FrameInputs(CAMERA, hud=HudText(is_hypothetical=True)))[where].mean(axis=0)
    assert amber[0] > 2.0 * amber[2]


def test_a_long_title_pushes_the_mark_aside(stage) -> None:
    hud = HudText(title="A title that reaches far into the picture", legend=False, scale_and_north=False)
    title = changed(stage, hud)
    both = changed(stage, dataclasses.replace(hud, is_hypothetical=True))

    assert np.array_equal(both & title, title)
    assert np.flatnonzero((both & ~title).any(axis=0)).min() > np.flatnonzero(title.any(axis=0)).max()


def test_a_notice_pushes_the_mark_down(stage) -> None:
    hud = HudText(is_hypothetical=True, notice="connection lost", legend=False, scale_and_north=False)
    where = changed(stage, hud).any(axis=1)

    assert np.flatnonzero(where).max() > 40


def test_the_legend_needs_water_and_follows_its_style(stage, hilly: Heightfield) -> None:
    hud = HudText(scale_and_north=False)
    assert not changed(stage, hud).any()

    frame = WaterFrame("w", np.ones(hilly.z_b.shape, dtype=np.float32))
    ramp = changed(stage, hud, water=WaterPair(frame, frame))
    colouring = Colouring(WaterColour.DEPTH, DEPTH_SCALE)
    classes = changed(stage, hud, water=WaterPair(frame, frame), colouring=colouring)
    assert ramp[250:, :200].any()
    assert classes.sum() > ramp.sum()


def test_a_panel_is_made_anew_only_when_it_says_something_else(
    stage, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[str] = []
    original = hud_panels.text_panel

    def counting(title: str, time: str, detail: str, scale: float):
        made.append(time)
        return original(title, time, detail, scale)

    monkeypatch.setattr(hud_panels, "text_panel", counting)
    for time in ("00:20", "00:20", "00:40", "00:40"):
        stage.draw(FrameInputs(CAMERA, hud=HudText(time=time)))

    assert made == ["00:20", "00:40"]


def test_a_pin_ends_where_the_place_is_and_its_name_gives_way_to_one_before(stage) -> None:
    point = (100.0, 40.0, -50.0)
    seen = CAMERA.seen_at(point, 640 / 360)
    assert seen is not None
    plain = stage.draw(FrameInputs(CAMERA, hud=HudText())).astype(int)

    def where(*marks: PlaceMark) -> np.ndarray:
        return (stage.draw(FrameInputs(CAMERA, hud=HudText(), marks=marks)) != plain).any(axis=2)

    one = where(PlaceMark("gauge", point))
    rows, columns = np.nonzero(one)
    assert rows.max() == pytest.approx(180.0 * (1.0 - seen[1]), abs=2.0)
    assert columns.mean() == pytest.approx(320.0 * (1.0 + seen[0]), abs=3.0)
    twice = where(PlaceMark("gauge", point), PlaceMark("another", point))
    assert np.array_equal(twice, one)
    assert not where(PlaceMark("behind", tuple(2.0 * CAMERA.eye - np.array(CAMERA.target)))).any()
