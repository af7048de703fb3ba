"""Sections count the water that the solver moved."""

import dataclasses

import numpy as np
import pytest

from solver_service.numerics import EdgeBoundary, FloodModel, Section, Weir
from tests.solver_service.numerics.floods import differences, full_model, solver, wild_water

RING = Section("ring", ((10.5, 12.5), (10.5, 40.5), (35.2, 55.5), (60.5, 20.5), (30.0, 8.5), (10.5, 12.5)))
LINE = Section("line", ((30.5, -0.5), (30.5, 69.5)))
LEVEE = Weir("levee", ((20.0, 20.0), (40.0, 44.0)), 1.9)


def enclosed(section, shape, row, col):
    """Cells reached from a cell without crossing the section."""
    east, north = np.zeros(shape, bool), np.zeros(shape, bool)
    for r, c, side in section.chain(shape).faces.tolist():
        (north if side else east)[r, c] = True
    inside = np.zeros(shape, bool)
    inside[row, col] = True
    while True:
        wider = inside.copy()
        wider[:, 1:] |= inside[:, :-1] & ~east[:, :-1]
        wider[:, :-1] |= inside[:, 1:] & ~east[:, :-1]
        wider[1:] |= inside[:-1] & ~north[:-1]
        wider[:-1] |= inside[1:] & ~north[:-1]
        if np.array_equal(wider, inside):
            return inside
        inside = wider


def flood(structures=(), **params):
    model = dataclasses.replace(full_model(rain=False), sources=(), structures=structures)
    s = solver(model, sections=(RING, LINE), gauge_interval=0.5, **params)
    s.set_water(*wild_water(model.z_b))
    return s


@pytest.mark.parametrize("structures", [(), (LEVEE,)], ids=["free", "over a weir"])
def test_a_closed_ring_accounts_for_the_water_inside(structures):
    s = flood(structures, threads=1)
    inside = enclosed(RING, s.model.shape, 30, 30)
    assert 1000 < inside.sum() < inside.size // 2
    before = s.depth()[inside].sum(dtype=np.float64)
    s.advance_to(6.0)
    gained = (s.depth()[inside].sum(dtype=np.float64) - before) * s.model.dx**2
    ring = s.section_totals()[0]  # drawn clockwise: its right is inside
    assert abs(gained) > 100.0
    assert ring.volume == pytest.approx(gained, abs=1e-4)
    assert s.section_series().volume[-1, 0] == pytest.approx(gained, abs=1e-4)


def test_every_engine_and_any_number_of_threads_record_the_same():
    runs = [
        flood((LEVEE,), **kw)
        for kw in ({"engine": "kernels"}, {"threads": 1}, {"threads": 3}, {"engine": "tiles"})
    ]
    for s in runs:
        s.advance_to(1.3)
        s.advance_to(4.0)
    first = runs[0].section_series()
    assert first.times == pytest.approx(np.arange(9) * 0.5)
    for s in runs[1:]:
        for name in ("discharge", "volume", "area"):
            assert np.array_equal(getattr(first, name), getattr(s.section_series(), name))
        assert s.section_totals() == runs[0].section_totals()


def test_a_restored_run_records_what_the_whole_run_does():
    whole, first, second = flood(threads=1), flood(threads=1), flood(threads=1)
    first.advance_to(2.2)
    second.restore(first.snapshot())
    whole.advance_to(2.2)
    for s in (whole, second):
        s.advance_to(5.0)
    assert np.array_equal(whole.section_series().discharge, second.section_series().discharge)
    assert whole.section_totals() == second.section_totals()


def test_sections_do_not_change_the_flood():
    plain = solver(flood().model, threads=1)
    plain.set_water(*wild_water(plain.model.z_b))
    watched = flood(threads=1)
    for s in (plain, watched):
        s.advance_to(3.0)
    assert set(differences(plain, watched)) <= {"gauge_h", "gauge_u", "gauge_eta"}


def test_a_steady_channel_passes_its_discharge_with_the_sign_of_the_line():
    nx, rows, dx, q = 60, 5, 10.0, 1.2
    bed = np.broadcast_to(0.004 * dx * np.arange(nx)[::-1], (rows, nx)).astype(np.float32)
    edges = (
        EdgeBoundary("west", "discharge", 0, rows, "", [0.0], [q * dx * rows]),
        EdgeBoundary("east", "normal_depth", 0, rows, slope=0.004),
    )
    sections = (
        Section("north", ((20.5, -0.5), (20.5, 4.5))),
        Section("south", ((40.5, 4.5), (40.5, -0.5))),
        Section("slanting", ((25.5, -0.5), (31.5, 4.5))),
    )
    s = solver(FloodModel(dx, bed, 0.03, boundaries=edges), sections=sections, gauge_interval=30.0, threads=1)
    s.advance_to(1800.0)
    last = s.section_series()
    assert last.discharge[-1] == pytest.approx([60.0, -60.0, 60.0], rel=2e-4)
    depth = (0.03 * q / np.sqrt(0.004)) ** 0.6
    assert last.area[-1, :2] == pytest.approx([50.0 * depth, 50.0 * depth], rel=1e-3)
    totals = s.section_totals()
    assert totals[0].volume == pytest.approx(last.volume[-1, 0])
    assert totals[0].peak >= last.discharge[:, 0].max()
    assert 0.0 < totals[0].peak_time <= 1800.0
    profile = s.section_profile(0)
    assert profile.distance == pytest.approx([5.0, 15.0, 25.0, 35.0, 45.0])
    assert profile.speed == pytest.approx(np.full(5, q / depth), rel=1e-3)
    assert profile.h == pytest.approx(np.full(5, depth), rel=1e-3)


def test_a_section_starts_with_the_discharge_of_the_water_as_it_stands():
    h = np.full((6, 8), 2.0, np.float32)
    s = solver(FloodModel(5.0, np.zeros((6, 8)), 0.0), sections=(Section("a", ((3.5, -0.5), (3.5, 5.5))),))
    s.set_water(h, 0.5 * h)
    series = s.section_series()
    assert series.discharge[0] == pytest.approx([60.0])
    assert series.area[0] == pytest.approx([60.0])
    assert np.isnan(s.section_totals()[0].peak_time)
