"""Everything a picture may depend on. What is not in here cannot change a picture."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
import numpy.typing as npt

from viewer.lod.block_tiling import Border
from viewer.units import METRIC, Units
from viewer.world.camera import Camera
from viewer.world.coordinates import Point
from viewer.world.flow_arrows import FlowField
from viewer.world.heightfield import Heightfield
from viewer.world.water_scales import ClassScale, WaterColour

__all__ = [
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
    "WaterFrame",
    "WaterPair",
    "same_marks",
]


class LineStyle(Enum):
    """What a draped line stands for."""

    RAISE = "raise"
    LOWER = "lower"
    DRAFT = "draft"
    SECTION = "section"
    SELECTED = "selected"
    MEASURE = "measure"


@dataclass(frozen=True)
class WaterFrame:
    """One output time of the flood."""

    key: Hashable
    """Names this water, say (run, index): equal keys mean equal arrays, which are then uploaded once."""
    h: npt.NDArray[np.float32]
    """Depth [m], shape [nrows, ncols], 0 where dry."""
    states: npt.NDArray[np.uint8] | None = None
    """Block states of the wire (stride 32): 0 dry, 1 partial, 2 wet, shape [block_rows, block_cols].
    None lets the renderer classify the depth itself."""
    z_b: npt.NDArray[np.float32] | None = None
    """The bed under this water [m, datum-relative]: base plus the edits of its run, not the preview.
    None means the heightfield as it was when the renderer was made. Hand over the same object for the same
    bed."""


@dataclass(frozen=True)
class WaterPair:
    """Two frames and where between them playback stands: h = (1 - alpha) first + alpha second."""

    first: WaterFrame
    second: WaterFrame
    alpha: float = 0.0


@dataclass(frozen=True)
class DrapedLine:
    """A line laid on the ground."""

    vertices: tuple[tuple[float, float], ...]
    """Grid coordinates [m]."""
    width: float
    """[m]"""
    style: LineStyle


@dataclass(frozen=True)
class PlaceMark:
    """A pin with a name, drawn over everything in the scene."""

    name: str
    point: Point
    """The foot of the pin, in the world [m]."""
    is_chosen: bool = False
    """Drawn in another colour."""


@dataclass(frozen=True)
class EditOverlay:
    """The marks of terrain edits."""

    revision: int
    """Counts the changes of the sign mask; the same array under the same number is uploaded once."""
    sign: npt.NDArray[np.int8]
    """+1 raised, -1 lowered, 0 untouched, shape [nrows, ncols]."""
    lines: tuple[DrapedLine, ...] = ()


@dataclass(frozen=True)
class DepthDifference:
    """How much deeper the water is than in another run at the same time."""

    key: Hashable
    """Names this difference: equal keys mean equal arrays, which are then uploaded once."""
    metres: npt.NDArray[np.float32]
    """Depth here less depth there [m], shape [nrows, ncols]."""
    other: str
    """The other run in words, for the legend."""


@dataclass(frozen=True)
class CellField:
    """One value a cell."""

    key: Hashable
    """Names this field: equal keys mean equal arrays, which are then uploaded once."""
    values: npt.NDArray[np.float32]
    """Shape [nrows, ncols]."""


@dataclass(frozen=True)
class Colouring:
    """Classes in which the water is coloured instead of its natural look, with a legend on the picture."""

    colour: WaterColour
    """Not natural."""
    scale: ClassScale
    fields: tuple[CellField, ...] = ()
    """Depth: none. Speed and hazard: the speeds of both frames of the water [m/s]. Else one field of the
    whole run, negative where water never came; it colours dry ground too."""


@dataclass(frozen=True)
class HudText:
    """What is written on the picture, in the window and headless alike."""

    title: str = ""
    time: str = ""
    """Simulated and clock time, ready to show."""
    detail: str = ""
    """Run, branch, speed against real time, and so on; lines are split at line feeds."""
    is_hypothetical: bool = False
    """Marks the picture as not showing a real event."""
    legend: bool = True
    """Show the depth legend (when there is water)."""
    scale_and_north: bool = True
    """Show scale bar and north arrow."""
    notice: str = ""
    """A warning in the middle of the upper border, say that the connection is lost."""


@dataclass(frozen=True)
class RenderOptions:
    """What the user may choose about the picture."""

    exaggeration: float = 1.0
    """Vertical exaggeration."""
    tau_px: float = 2.0
    """Largest screen error of the terrain's level of detail [pixels]."""
    water_spacing_px: float = 2.0
    """Vertices of fully wet blocks may lie this far apart on the screen [pixels]; 0 draws all of them."""
    partial_spacing_px: float = 0.0
    """The same for partially wet blocks; 0 draws every grid vertex, as an exact shore asks."""
    full_mesh: bool = False
    """Draw every vertex of the terrain: the oracle of the tests."""
    block_size: int = 33
    """Vertices along a block's side: 17, 33 or 65."""
    border: Border = Border.RAGGED
    """What is done with rows and columns of the map that fill no whole block."""
    snap_edges: bool = True
    """Fit block edges to coarser neighbours; without it cracks open (for tests and demonstrations)."""
    cull: bool = True
    """Leave out blocks outside of the view."""
    quadtree: bool | None = None
    """Find the blocks in view by the quadtree; None does so on large maps. It changes no picture."""
    cull_covered_terrain: bool = True
    """Leave out terrain under fully wet blocks."""
    classify_water: bool = True
    """Leave out the water of dry blocks and fit the ground to it; without, all is drawn (to compare)."""
    wireframe: bool = False
    show_blocks: bool = False
    """Colour blocks by level of detail."""
    show_water: bool = True
    show_terrain: bool = True
    show_sky: bool = True
    show_skirt: bool = True
    """Walls below the border of the map."""
    show_edits: bool = True
    """Lines and colours where the ground is edited."""
    show_gauges: bool = True
    """Marks of gauges and sections."""
    show_text: bool = True
    """Title, legend, scale bar and north arrow; that an event is hypothetical is told in any case."""
    show_imagery: bool = True
    """Use the imagery texture, if there is one."""
    contour_interval: float = 0.0
    """Height between contour lines [m]; 0 for none."""
    water_colour: WaterColour = WaterColour.NATURAL
    """What water is to be coloured by; `FrameInputs.colouring` brings it once its values are at hand."""
    flow_arrows: bool = False
    """Whether the user wants arrows of the flow; `FrameInputs.flow` brings them once they are at hand."""
    depth_shown: float = 0.01
    """Water shallower than this is not drawn [m]."""
    light_azimuth_deg: float = 315.0
    """Compass bearing from which the sun shines."""
    light_elevation_deg: float = 42.0
    """Height of the sun above the horizon."""
    fog: bool = True
    """Let far ground fade into the horizon."""
    samples: int = 0
    """Multisampling: 0 or 4."""
    render_scale: float = 1.0
    """Pixels of the scene for each pixel of the picture, along one side.

    Below 1 for slow machines, 2 for smooth pictures; panels stay as sharp as they are.
    """
    units: Units = METRIC
    """Units of everything written on the picture."""
    background: tuple[float, float, float] = (0.62, 0.70, 0.80)
    """Colour behind everything where no sky is drawn."""


@dataclass(frozen=True, eq=False)
class Beside:
    """Another run's picture right of a divider, with the same camera and options."""

    at: float
    """Where the divider stands, as a share of the picture's width from the left."""
    heightfield: Heightfield
    """Its ground."""
    inputs: FrameInputs
    """What its picture depends on; the text on the picture is that of the run to the left."""
    left: str
    """The run to the left in words."""
    right: str


@dataclass(frozen=True)
class FrameInputs:
    """One picture."""

    camera: Camera
    water: WaterPair | None = None
    edits: EditOverlay | None = None
    options: RenderOptions = field(default_factory=RenderOptions)
    hud: HudText | None = None
    difference: DepthDifference | None = None
    """Colours ground and water by the difference to another run."""
    colouring: Colouring | None = None
    """Colours the water in classes; None leaves it natural."""
    flow: FlowField | None = None
    """Arrows on the water; None draws none."""
    beside: Beside | None = None
    """Another run right of a divider; None gives this one the whole picture."""
    marks: tuple[PlaceMark, ...] = ()
    """Gauges and sections by name."""
    lines: tuple[DrapedLine, ...] = ()
    """Lines on the ground beside those of edits."""
    is_outdated: bool = False
    """The flood may have gone on unseen, say since the service is gone: the scene is drawn in grey."""


@dataclass(frozen=True)
class FrameStats:
    """What a picture cost."""

    terrain_triangles: int
    """Without triangles of no area."""
    water_triangles: int
    terrain_blocks: int
    water_blocks: int
    culled_blocks: int
    """Blocks outside of the view."""
    covered_blocks: int
    """Visible blocks whose terrain lies under water entirely."""
    draws: int
    near: float
    far: float
    selection_ms: float
    """Python time of choosing levels [ms]."""
    submission_ms: float
    """Python time of everything else in `Renderer.draw` [ms]."""


def same_marks(first: EditOverlay | None, second: EditOverlay | None) -> bool:
    """Whether two overlays mark the same cells; another run may count its revisions from the start again."""
    if first is None or second is None:
        return first is second
    return first.revision == second.revision and first.sign is second.sign
