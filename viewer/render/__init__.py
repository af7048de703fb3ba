"""Pictures by OpenGL 4.1 core; knows no window toolkit, no network, no protocol."""

from viewer.render.context import check_context, create_headless_context
from viewer.render.frame_inputs import (
    Beside,
    CellField,
    Colouring,
    DepthDifference,
    DrapedLine,
    EditOverlay,
    FrameInputs,
    FrameStats,
    HudText,
    LineStyle,
    PlaceMark,
    RenderOptions,
    WaterFrame,
    WaterPair,
)
from viewer.render.picking import Unprojection, march_ray
from viewer.render.renderer import Renderer

__all__ = [
    "Beside",
    "CellField",
    "Colouring",
    "DepthDifference",
    "DrapedLine",
    "EditOverlay",
    "FrameInputs",
    "FrameStats",
    "HudText",
    "LineStyle",
    "PlaceMark",
    "RenderOptions",
    "Renderer",
    "Unprojection",
    "WaterFrame",
    "WaterPair",
    "check_context",
    "create_headless_context",
    "march_ray",
]
