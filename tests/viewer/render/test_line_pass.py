import math
from collections.abc import Callable

import numpy as np
import pytest

from viewer.render import DrapedLine, EditOverlay, FrameInputs, LineStyle
from viewer.render.line_pass import drape
from viewer.world import Camera, Heightfield


def test_a_draped_line_lies_on_the_ground_and_leaves_out_no_cell(hilly: Heightfield) -> None:
    points = drape(hilly, ((1500.0, 5500.0), (2500.0, 6000.0), (2600.0, 5300.0)))
    steps = np.hypot(*np.diff(points[:, :2], axis=0).T)

    assert steps.max() <= 0.5 * hilly.grid.dx + 1e-9
    assert points[:, 2] == pytest.approx(hilly.sample(points[:, 0], points[:, 1]))
    assert points[0, :2].tolist() == [1500.0, 5500.0]
    assert points[-1, :2].tolist() == [2600.0, 5300.0]


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
