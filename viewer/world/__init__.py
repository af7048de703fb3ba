"""The world of the viewer: pure data and time; NumPy only, no OpenGL, no sockets."""

from viewer.world.camera import Camera, GroundHeight, overview
from viewer.world.coordinates import Point, WorldFrame
from viewer.world.depth_classes import (
    DEPTH_CLASS_COLOURS,
    DEPTH_CLASS_LIMITS,
    depth_class,
    depth_class_labels,
)
from viewer.world.edit_document import EditDocument, EditPreview
from viewer.world.edit_measures import EditMeasure, measure_edits
from viewer.world.frame_cache import FrameCache
from viewer.world.frustum import Frustum
from viewer.world.heightfield import Heightfield, Rect, union_rect
from viewer.world.orbit_motion import Flight, Move, OrbitMotion
from viewer.world.playback_clock import PlaybackClock
from viewer.world.probe import ProbeReading, probe
from viewer.world.reference_map import MapView, flood_extent, ground_in_view, relief_map
from viewer.world.water_timeline import Bracket, WaterTimeline

__all__ = [
    "DEPTH_CLASS_COLOURS",
    "DEPTH_CLASS_LIMITS",
    "Bracket",
    "Camera",
    "EditDocument",
    "EditMeasure",
    "EditPreview",
    "Flight",
    "FrameCache",
    "Frustum",
    "GroundHeight",
    "Heightfield",
    "MapView",
    "Move",
    "OrbitMotion",
    "PlaybackClock",
    "Point",
    "ProbeReading",
    "Rect",
    "WaterTimeline",
    "WorldFrame",
    "depth_class",
    "depth_class_labels",
    "flood_extent",
    "ground_in_view",
    "measure_edits",
    "overview",
    "probe",
    "relief_map",
    "union_rect",
]
