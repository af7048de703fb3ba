"""The reference map of a viewer on the tiny service."""

import numpy as np

from tests.viewer.app.conftest import Flight
from tests.viewer.app.test_viewer_app import draw_levee
from tests.viewer.tiny_service import INTERVAL
from viewer.commands import FlyTo, Pause, Seek
from viewer.world import MapView


def shown_map(flight: Flight) -> MapView:
    view = flight.app.map_view()
    assert view is not None
    return view


def test_there_is_no_map_before_there_is_a_terrain(flight: Flight) -> None:
    flight.app.control.shown = None

    assert flight.app.map_view() is None


def test_the_flood_of_the_map_follows_the_playback_time(flight: Flight) -> None:
    flight.do(Pause(), Seek(2 * INTERVAL))
    flight.settle()
    flight.until(lambda: shown_map(flight).flood.any())
    early = shown_map(flight).flood
    flight.do(Seek(19 * INTERVAL))
    flight.settle()
    flight.until(lambda: shown_map(flight).flood is not early)

    assert shown_map(flight).flood.sum() > early.sum()


def test_the_map_is_the_same_object_until_the_camera_moves(flight: Flight) -> None:
    flight.do(Pause(), Seek(5 * INTERVAL))
    flight.settle()
    flight.until(lambda: shown_map(flight).flood.any())
    before = shown_map(flight)
    assert flight.app.map_view() is before
    flight.do(FlyTo(1200.0, 2300.0, distance=300.0, seconds=0.0))
    after = shown_map(flight)

    assert after is not before
    assert after.relief is before.relief
    np.testing.assert_allclose(after.target, (1200.0, 2300.0), atol=1e-6)


def test_an_edit_shows_on_the_relief(flight: Flight) -> None:
    flight.do(Pause())
    before = shown_map(flight).relief
    draw_levee(flight)
    flight.until(lambda: shown_map(flight).relief is not before)

    assert (shown_map(flight).relief != before).any()
