import math
from collections.abc import Callable

import numpy as np
import pytest

from viewer.render import DrapedLine, EditOverlay, FrameInputs, LineStyle, WaterFrame, WaterPair
from viewer.render.line_pass import drape
from viewer.world import Camera, Heightfield


def test_a_draped_line_leaves_out_no_cell(hilly: Heightfield) -> None:
    points = drape(hilly, ((1500.0, 5500.0), (2500.0, 6000.0), (2600.0, 5300.0)))
    steps = np.hypot(*np.diff(points, axis=0).T)

    assert steps.max() <= 0.5 * hilly.grid.dx + 1e-9
    assert points[0].tolist() == [1500.0, 5500.0]
    assert points[-1].tolist() == [2600.0, 5300.0]


@pytest.mark.gl
def test_lines_show_in_the_colour_of_their_style(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    camera = Camera((0.0, 0.0, 0.0), 1200.0, 0.0, math.pi / 2)
    sign = np.zeros(hilly.z_b.shape, dtype=np.int8)
    x, y, _ = hilly.frame.from_world((0.0, 0.0, 0.0))
    plain = stage.draw(FrameInputs(camera, edits=EditOverlay(1, sign))).astype(int)
    shown = {}
    for style in LineStyle:
        line = DrapedLine(((x - 300.0, y), (x + 300.0, y)), 30.0, style)
        picture = stage.draw(FrameInputs(camera, edits=EditOverlay(1, sign, (line,)))).astype(int)
        where = (picture != plain).any(axis=2)
        rows, cols = np.nonzero(where)
        assert 100 < where.sum() < 4000
        assert abs(rows.mean() - 150.0) < 12.0
        assert abs(cols.mean() - 240.0) < 5.0
        shown[style] = picture[where].mean(axis=0)

    assert shown[LineStyle.RAISE][0] > shown[LineStyle.RAISE][2] + 40.0
    assert shown[LineStyle.LOWER][2] > shown[LineStyle.LOWER][0] + 40.0


@pytest.mark.gl
def test_a_first_vertex_alone_already_shows_its_width(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    camera = Camera((0.0, 0.0, 0.0), 1200.0, 0.0, math.pi / 2)
    sign = np.zeros(hilly.z_b.shape, dtype=np.int8)
    x, y, _ = hilly.frame.from_world((0.0, 0.0, 0.0))
    plain = stage.draw(FrameInputs(camera, edits=EditOverlay(1, sign)))
    line = DrapedLine(((x, y),), 200.0, LineStyle.DRAFT)
    where = (stage.draw(FrameInputs(camera, edits=EditOverlay(1, sign, (line,)))) != plain).any(axis=2)
    width_px = np.ptp(np.flatnonzero(where.any(axis=0)))

    assert width_px == pytest.approx(200.0 * 300 / (2.0 * math.tan(camera.fov_y / 2) * 1200.0), rel=0.25)


@pytest.mark.gl
def test_a_line_on_flooded_ground_lies_on_the_water(hilly: Heightfield, make_stage: Callable) -> None:
    stage = make_stage(hilly)
    camera = Camera((0.0, 0.0, 0.0), 1200.0, 0.0, math.radians(60.0))
    sign = np.zeros(hilly.z_b.shape, dtype=np.int8)
    x, y, _ = hilly.frame.from_world((0.0, 0.0, 0.0))
    frame = WaterFrame("deep", np.full(hilly.z_b.shape, 20.0, dtype=np.float32))
    water = WaterPair(frame, frame)
    line = DrapedLine(((x - 300.0, y), (x + 300.0, y)), 30.0, LineStyle.RAISE)
    plain = stage.draw(FrameInputs(camera, water, EditOverlay(1, sign))).astype(int)
    where = (stage.draw(FrameInputs(camera, water, EditOverlay(1, sign, (line,)))) != plain).any(axis=2)

    # Unbroken from end to end, but for what a hill of water in front may hide.
    columns = np.flatnonzero(where.any(axis=0))
    assert columns.size > 0.9 * np.ptp(columns)
    assert np.ptp(columns) > 150
