"""Exact solutions of the shallow-water equations in float64, one a file.

Every solution is a frozen dataclass with ``bed(x, y)`` [m] and ``state(x, y, time) -> (h, u, v)`` [m, m/s,
m/s] on arrays of any shape. They are verified on their own in ``tests/validation/test_solutions.py`` and
``test_channel_solutions.py`` before they judge the solver.
"""

from tests.validation.solutions.bump import Bump
from tests.validation.solutions.dressler import Dressler
from tests.validation.solutions.macdonald import CHANNELS, MacDonald
from tests.validation.solutions.rain_on_plane import RainOnPlane
from tests.validation.solutions.ritter import Ritter
from tests.validation.solutions.simple_wave import SimpleWave
from tests.validation.solutions.stationary_vortex import StationaryVortex
from tests.validation.solutions.stoker import Stoker
from tests.validation.solutions.thacker_planar import ThackerPlanar
from tests.validation.solutions.thacker_radial import ThackerRadial
from tests.validation.solutions.wall_reflection import WallReflection

__all__ = [
    "CHANNELS",
    "Bump",
    "Dressler",
    "MacDonald",
    "RainOnPlane",
    "Ritter",
    "SimpleWave",
    "StationaryVortex",
    "Stoker",
    "ThackerPlanar",
    "ThackerRadial",
    "WallReflection",
]
