"""Levees and trenches under water."""

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, ModelError
from tests.solver_service.numerics.floods import bed, differences, solver


def lake(level=3.0):
    z = bed((50, 60))
    s = solver(FloodModel(5.0, z, 0.03), threads=1)
    s.set_water(np.maximum(np.float32(level) - z, 0.0))
    return s, z


def test_a_submerged_levee_keeps_the_level_and_the_rest():
    s, z = lake()
    raised = z.copy()
    raised[20:24, 5:30] += np.minimum(0.4, s.depth()[20:24, 5:30])
    change = s.replace_bed(raised)
    assert change.volume_cut == pytest.approx(float((raised - z).sum(dtype=np.float64)) * 25.0, rel=1e-6)
    s.advance_to(60.0)
    u, v = s.velocity()
    assert max(abs(u).max(), abs(v).max()) < 1e-6
    assert s.budget().edits == change.volume_cut
    assert abs(s.budget().error_relative) < 1e-7


def test_a_levee_out_of_the_water_dries_its_cells_and_holds():
    s, z = lake()
    raised = z.copy()
    raised[:, 30] = 6.0
    s.replace_bed(raised)
    assert not s.depth()[:, 30].any()
    s.advance_to(60.0)
    assert not s.depth()[:, 30].any()


def test_a_trench_keeps_the_depth_and_the_volume():
    s, z = lake()
    before = s.depth()
    lowered = z.copy()
    lowered[10:15, 10:40] -= 1.0
    assert s.replace_bed(lowered).volume_cut == 0.0
    assert np.array_equal(s.depth(), before)
    s.advance_to(30.0)
    assert abs(s.budget().error_relative) < 1e-7
    assert s.velocity()[0].any()


def test_velocity_is_kept_where_it_stays_wet_and_zero_where_it_falls_dry():
    z = np.zeros((20, 20), np.float32)
    s = solver(FloodModel(5.0, z, 0.0), threads=1)
    s.set_water(np.full(z.shape, 1.0), np.full(z.shape, 0.7))
    raised = z.copy()
    raised[5, 5], raised[6, 6] = 0.4, 2.0
    s.replace_bed(raised)
    u, _ = s.velocity()
    assert u[5, 5] == np.float32(0.7)
    assert u[6, 6] == 0.0


def test_restoring_brings_the_old_bed_back():
    s, z = lake()
    s.advance_to(2.0)
    snapshot = s.snapshot()
    s.replace_bed(z + np.float32(1.0))
    s.advance_to(3.0)
    s.restore(snapshot)
    assert np.array_equal(s.bed, z)
    fresh, _ = lake()
    fresh.advance_to(2.0)
    for one in (s, fresh):
        one.advance_to(5.0)
    assert differences(s, fresh) == []


@pytest.mark.parametrize(
    ("shape", "value", "words"), [((3, 3), 0.0, "shape"), ((50, 60), np.nan, "nan in cell")]
)
def test_a_bed_that_is_not_valid_is_refused(shape, value, words):
    s, _ = lake()
    with pytest.raises(ModelError, match=words):
        s.replace_bed(np.full(shape, value))


def test_the_same_bed_again_changes_nothing_that_follows():
    z = bed((50, 60))
    river = EdgeBoundary(
        "west", "discharge", 10, 40, times=[0.0, 8.0, 9.0, 40.0], values=[0.0, 0.0, 900.0, 900.0]
    )

    def flood():
        """A pond that is about to be hit by a wave from the edge, which shortens the step ahead of it."""
        s = solver(FloodModel(5.0, z, 0.03, boundaries=(river,)), threads=1)
        s.set_water(np.maximum(np.float32(0.6) - z, 0.0))
        s.advance_to(8.5)
        return s

    one, other = flood(), flood()
    change = other.replace_bed(z.copy())
    one.advance_to(20.0)
    other.advance_to(20.0)

    assert (change.volume_cut, change.changed_cells) == (0.0, 0)
    assert differences(one, other) == []
