"""The world of the viewer: pure data and time; NumPy only, no OpenGL, no sockets."""

from viewer.world.camera import Camera, GroundHeight, overview
from viewer.world.coordinates import Point, WorldFrame
from viewer.world.edit_document import EditDocument, EditPreview
from viewer.world.edit_measures import EditMeasure, measure_edits
from viewer.world.flow_arrows import Arrows, FlowField, arrow_speed, flow_arrows
from viewer.world.frame_cache import FrameCache
from viewer.world.frustum import Frustum
from viewer.world.heightfield import Heightfield, Rect, union_rect
from viewer.world.measure import Measure, measure
from viewer.world.moved_bed import MovedBed, bed_with, blended_bed
from viewer.world.orbit_motion import Flight, Move, OrbitMotion
from viewer.world.playback_clock import PlaybackClock
from viewer.world.probe import ProbeReading, probe
from viewer.world.reference_map import MapView, flood_extent, ground_in_view, relief_map
from viewer.world.water_scales import (
    DEPTH_SCALE,
    ClassScale,
    WaterColour,
    arrival_scale,
    hazard_rating,
    water_scale,
)
from viewer.world.water_timeline import Bracket, WaterTimeline

__all__ = [
    "DEPTH_SCALE",
    "Arrows",
    "Bracket",
    "Camera",
    "ClassScale",
    "EditDocument",
    "EditMeasure",
    "EditPreview",
    "Flight",
    "FlowField",
    "FrameCache",
    "Frustum",
    "GroundHeight",
    "Heightfield",
    "MapView",
    "Measure",
    "Move",
    "MovedBed",
    "OrbitMotion",
    "PlaybackClock",
    "Point",
    "ProbeReading",
    "Rect",
    "WaterColour",
    "WaterTimeline",
    "WorldFrame",
    "arrival_scale",
    "arrow_speed",
    "bed_with",
    "blended_bed",
    "flood_extent",
    "flow_arrows",
    "ground_in_view",
    "hazard_rating",
    "measure",
    "measure_edits",
    "overview",
    "probe",
    "relief_map",
    "union_rect",
    "water_scale",
]
