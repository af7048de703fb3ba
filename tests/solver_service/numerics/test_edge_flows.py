"""Steady flows between edges, and waves that come and go through them, against theory."""

import numpy as np
import pytest

from tests.solver_service.numerics.edge_models import channel, edge

G = 9.81


# --- steady flow ------------------------------------------------------------------------------------


def uniform_flow(slope, down, until, q=2.0, manning_n=0.03, dx=20.0, cols=60, rows=3):
    depth = (manning_n * q / np.sqrt(slope)) ** 0.6
    kw = {
        "normal_depth": {"slope": slope},
        "open": {},
        "stage": {"times": [0.0], "values": [depth - 0.5 * slope * dx]},
    }
    boundaries = (
        edge("west", "discharge", 0, rows, times=[0.0, 60.0], values=[0.0, q * dx * rows]),
        edge("east", down, 0, rows, **kw[down]),
    )
    z = slope * dx * np.arange(cols)[::-1]
    s = channel(dx * cols, dx, boundaries, z, manning_n, rows)
    s.advance_to(until)
    return s, s.depth().astype(np.float64) / depth - 1.0


@pytest.mark.parametrize("down", ["normal_depth", "stage"])
def test_uniform_flow_has_the_depth_of_manning_up_to_both_edges(down):
    s, off = uniform_flow(0.002, down, 4000.0)
    assert abs(off).max() < 2e-5
    h, u = s.depth()[1], s.velocity()[0][1]
    assert h * u == pytest.approx(np.full(60, 2.0), rel=1e-4)


def test_supercritical_flow_leaves_through_any_edge_as_it_comes():
    for down in ("normal_depth", "stage", "open"):
        _, off = uniform_flow(0.02, down, 1000.0)
        assert abs(off[:, 20:]).max() < 1e-5


def test_a_slope_wrong_by_a_hundredth_would_be_seen():
    z = 0.002 * 20.0 * np.arange(60)[::-1]
    boundaries = (
        edge("west", "discharge", 0, 3, times=[0.0], values=[120.0]),
        edge("east", "normal_depth", 0, 3, slope=0.00202),
    )
    s = channel(1200.0, 20.0, boundaries, z, 0.03, 3)
    s.advance_to(3000.0)
    depth = (0.03 * 2.0 / np.sqrt(0.002)) ** 0.6
    assert abs(s.depth()[1, -1] / depth - 1.0) > 1e-3


def test_flow_over_a_bump_between_discharge_and_stage_has_bernoullis_surface():
    q, level, dx = 4.42, 2.0, 0.25
    x = (np.arange(100) + 0.5) * dx
    z = np.maximum(0.2 - 0.05 * (x - 10.0) ** 2, 0.0)
    boundaries = (
        edge("west", "discharge", 0, 2, times=[0.0], values=[q * 2 * dx]),
        edge("east", "stage", 0, 2, times=[0.0], values=[level]),
    )
    s = channel(25.0, dx, boundaries, z)
    s.set_water(np.broadcast_to(level - z, (2, 100)))
    s.advance_to(200.0)
    head = level + q * q / (2.0 * G * level * level)
    exact = [max(r.real for r in np.roots([1.0, b - head, 0.0, q * q / (2.0 * G)])) for b in z]
    assert abs(s.depth()[0] - exact).mean() < 4e-4
    assert s.depth()[0, [0, -1]] == pytest.approx([exact[0], exact[-1]], rel=3e-4)


# --- waves ------------------------------------------------------------------------------------------


def test_a_tide_that_resonates_in_a_basin_has_the_amplitude_of_theory():
    dx, depth, amplitude, period, length = 500.0, 20.0, 0.1, 11178.5, 20000.0
    times = np.arange(0.0, 7.0 * period, period / 100)
    omega = 2.0 * np.pi / period
    values = amplitude * np.sin(omega * times) * np.minimum(times / (2.0 * period), 1.0)
    s = channel(
        length, dx, (edge("west", "stage", 0, 2, id="sea", times=times, values=values),), -depth,
        gauges=((39, 0),), gauge_interval=period / 50,
    )  # fmt: skip
    s.set_water(np.full((2, 40), depth))
    s.advance_to(6.0 * period)
    swing = np.ptp(s.gauge_series().h[-51:, 0]) / (2.0 * amplitude)
    assert swing == pytest.approx(1.0 / np.cos(omega / np.sqrt(G * depth) * length), rel=1e-2)
    came, left = s.budget().edges["sea"]
    assert min(came, left) > 1e6
    assert came - left == pytest.approx(s.budget().stored - s.budget().initial, rel=1e-5)


@pytest.mark.parametrize("downstream", [0.0, 0.05, 1.0])
def test_a_dam_break_leaves_through_an_open_edge_without_coming_back(downstream):
    def run(cells, boundaries):
        s = channel(float(cells), 1.0, boundaries)
        h = np.full((2, cells), downstream)
        h[:, :50] = 2.0
        s.set_water(h)
        s.advance_to(20.0)
        return s.depth()[0, :100].astype(np.float64)

    off = run(100, (edge("east", "open", 0, 2),)) - run(300, ())
    assert abs(off).max() < 4e-3
    walled = run(100, ()) - run(300, ())
    assert abs(walled).max() > 0.3


def test_a_hump_of_water_leaves_nothing_behind():
    s = channel(100.0, 1.0, (edge("east", "open", 0, 2), edge("west", "open", 0, 2)))
    x = np.arange(100) + 0.5
    s.set_water(np.broadcast_to(5.0 + 0.5 * np.exp(-(((x - 50.0) / 6.0) ** 2)), (2, 100)))
    s.advance_to(40.0)
    assert abs(s.depth() - 5.0).max() < 5e-4
