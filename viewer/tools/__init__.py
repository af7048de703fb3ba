"""What the mouse and the keys mean: pointer and key events in, commands out; knows no toolkit."""

from viewer.tools.bindings import Bindings, MouseTable
from viewer.tools.edit_tool import EditTool
from viewer.tools.level_tool import LevelTool
from viewer.tools.measure_tool import MeasureTool
from viewer.tools.motion_keys import MotionKeys
from viewer.tools.orbit_tool import OrbitTool
from viewer.tools.pointer import PointerEvent
from viewer.tools.select_tool import SelectTool
from viewer.tools.toolbox import Toolbox

__all__ = [
    "Bindings",
    "EditTool",
    "LevelTool",
    "MeasureTool",
    "MotionKeys",
    "MouseTable",
    "OrbitTool",
    "PointerEvent",
    "SelectTool",
    "Toolbox",
]
