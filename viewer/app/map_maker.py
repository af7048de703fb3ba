"""Keeps the reference map: its rasters are made anew only when ground or water have changed."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from viewer.app.camera_work import CameraWork
from viewer.app.shown_run import ShownRun
from viewer.app.water_feed import WaterFeed
from viewer.net import FrameKey
from viewer.world import Camera, Heightfield, MapView, WorldFrame, flood_extent, ground_in_view, relief_map

__all__ = ["MapMaker"]

WATER_PERIOD_S = 0.25
"""The flood of the map is renewed at most this often [s]."""


class MapMaker:
    """Makes the reference map of what is shown."""

    def __init__(self) -> None:
        self._field: Heightfield | None = None
        self._revision = -1
        self._relief: npt.NDArray[np.uint8] = np.zeros((1, 1, 3), np.uint8)
        self._water: FrameKey | None = None
        self._flood: npt.NDArray[np.bool_] = np.zeros((1, 1), bool)
        self._flood_made = -math.inf
        self._view: MapView | None = None
        self._shows: tuple[Camera, WorldFrame, float] | None = None

    def map_view(
        self, shown: ShownRun, work: CameraWork, feed: WaterFeed, depth_shown: float, now: float
    ) -> MapView:
        """Return the map; the same object while nothing on it has changed.

        Args:
            shown: the run on the picture.
            work: the camera.
            feed: the water on the picture.
            depth_shown: water shallower than this does not count [m].
            now: wall time [s, monotonic].
        """
        field = shown.heightfield
        if self._field is not field:
            self._field, self._revision = field, -1
            self._water, self._flood_made = None, -math.inf
        if self._revision != field.revision:
            self._revision, self._relief = field.revision, relief_map(field)
        if self._flood_made == -math.inf:
            self._flood = np.zeros(self._relief.shape[:2], bool)
        pair, keys = feed.pair, feed.keys
        if pair is not None and keys is not None and now - self._flood_made >= WATER_PERIOD_S:
            nearer = 1 if pair.alpha > 0.5 else 0
            if keys[nearer] != self._water:
                self._water, self._flood_made = keys[nearer], now
                self._flood = flood_extent((pair.second if nearer else pair.first).h, depth_shown)
        shows = (work.camera, work.frame, work.aspect)
        view = self._view
        has_both = view is not None and view.relief is self._relief and view.flood is self._flood
        if view is None or not has_both or shows != self._shows:
            self._shows = shows
            self._view = view = self._make(shown, work)
        return view

    def _make(self, shown: ShownRun, work: CameraWork) -> MapView:
        camera, frame = work.camera, work.frame
        eye = frame.from_world((float(camera.eye[0]), float(camera.eye[1]), float(camera.eye[2])))
        target = frame.from_world(camera.target)
        return MapView(
            relief=self._relief,
            flood=self._flood,
            extent=shown.grid.extent,
            eye=eye[:2],
            target=target[:2],
            in_view=ground_in_view(camera, work.aspect, frame),
        )
