"""The camera of the picture and the commands that move it."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from viewer.commands import (
    Command,
    CommandError,
    DragOrbit,
    DragPan,
    FlyTo,
    GrabView,
    HoldMove,
    ReleaseMoves,
    ResetView,
    TopView,
    Zoom,
)
from viewer.world import Camera, Heightfield, Move, OrbitMotion, WorldFrame, overview

__all__ = ["CameraWork"]

START_ELEVATION = math.radians(38.0)
TOP_ELEVATION = math.radians(90.0)
CLEARANCE_CELLS = 0.5


class CameraWork:
    """A camera over a terrain.

    Args:
        heightfield: the ground it flies over.
        exaggeration: vertical exaggeration of the picture.
        aspect: width over height of the picture.

    Attributes:
        camera: the pose now.
        aspect: width over height of the picture; kept by whoever draws.
    """

    def __init__(
        self, heightfield: Heightfield, exaggeration: float = 1.0, aspect: float = 16.0 / 9.0
    ) -> None:
        self._heightfield = heightfield
        self._motion = OrbitMotion()
        self._frame = heightfield.frame.exaggerated(exaggeration)
        self.aspect = aspect
        self._is_untouched = True
        self.camera = self._overview(START_ELEVATION)

    @property
    def is_moving(self) -> bool:
        """Whether the next picture will differ."""
        return self._motion.is_moving

    @property
    def frame(self) -> WorldFrame:
        """The map between grid coordinates and the world of the picture."""
        return self._frame

    def pose(self) -> FlyTo:
        """Return the command that brings back the view as it is now."""
        x, y, _ = self._frame.from_world(self.camera.target)
        azimuth, elevation = math.degrees(self.camera.azimuth), math.degrees(self.camera.elevation)
        return FlyTo(x, y, self.camera.distance, azimuth, elevation)

    def set_aspect(self, aspect: float) -> None:
        """Follow the shape of the picture; a view that nobody has changed yet shows all the terrain."""
        if abs(aspect - self.aspect) > 1e-3 and self._is_untouched:
            self.aspect = aspect
            self.camera = self._overview(START_ELEVATION)
        self.aspect = aspect

    def set_exaggeration(self, exaggeration: float) -> None:
        """Follow a change of the vertical exaggeration: the target keeps its place on the ground."""
        x, y, z = self._frame.from_world(self.camera.target)
        self._frame = self._heightfield.frame.exaggerated(exaggeration)
        self.camera = self.camera.with_target(self._frame.to_world(x, y, z))

    def advance(self, wall_dt: float) -> bool:
        """Move on by `wall_dt` [s] of wall time; return whether the camera has moved."""
        if not self._motion.is_moving:
            return False
        before = self.camera
        clearance = CLEARANCE_CELLS * self._heightfield.grid.dx
        self.camera = self._motion.advance(self.camera, wall_dt, self._ground_height, clearance)
        return self.camera != before

    def carry_out(self, command: Command) -> bool:
        """Carry out a camera command; return False when it is none.

        Raises:
            CommandError: an unknown move, or a place that is not finite.
        """
        match command:
            case GrabView(on):
                if on:
                    self._motion.begin_drag()
                else:
                    self._motion.end_drag()
            case DragOrbit(dx, dy):
                self._motion.drag_orbit(dx, dy)
            case DragPan(dx, dy):
                self._motion.drag_pan(dx, dy, self.camera)
            case Zoom(steps, x, y):
                self._motion.scroll(-steps, None if x is None or y is None else self._ground_point(x, y))
            case HoldMove(name, on):
                move = Move.__members__.get(name.upper())
                if move is None:
                    raise CommandError(
                        f"move {name!r} is unknown; known are {', '.join(Move.__members__).lower()}"
                    )
                if on:
                    self._motion.hold(move)
                else:
                    self._motion.release(move)
            case ReleaseMoves():
                self._motion.release_all()
            case FlyTo():
                self._fly_to(command)
            case ResetView():
                self._motion.fly_to(self.camera, self._overview(START_ELEVATION))
            case TopView():
                self._motion.fly_to(self.camera, self._overview(TOP_ELEVATION))
            case _:
                return False
        self._is_untouched = False
        return True

    def _fly_to(self, command: FlyTo) -> None:
        if not (math.isfinite(command.x) and math.isfinite(command.y)):
            raise CommandError(f"a flight to ({command.x!r}, {command.y!r}) is not possible")
        if command.distance is not None and not command.distance > 0.0:
            raise CommandError(f"FlyTo.distance = {command.distance!r} is not allowed; it must be above 0 m")
        x_world, _, z_world = self._frame.to_world(command.x, command.y, 0.0)
        end = dataclasses.replace(
            self.camera,
            target=(x_world, float(self._ground_height(x_world, z_world)), z_world),
            distance=self.camera.distance if command.distance is None else command.distance,
            azimuth=self.camera.azimuth if command.azimuth is None else math.radians(command.azimuth),
            elevation=self.camera.elevation if command.elevation is None else math.radians(command.elevation),
        )
        if command.seconds > 0.0:
            self._motion.fly_to(self.camera, end, command.seconds)
        else:
            self._motion = OrbitMotion()
            self.camera = end.kept_above(self._ground_height, CLEARANCE_CELLS * self._heightfield.grid.dx)

    def _ground_point(self, x: float, y: float) -> tuple[float, float, float]:
        return self._frame.to_world(x, y, float(self._heightfield.sample(x, y)))

    def _overview(self, elevation: float) -> Camera:
        grid = self._heightfield.grid
        middle = 0.5 * (self._heightfield.z_min + self._heightfield.z_max)
        extent_x, extent_y = grid.ncols * grid.dx, grid.nrows * grid.dx
        height = float(self._frame.height(middle))
        return overview(extent_x, extent_y, height, elevation=elevation, aspect=self.aspect)

    def _ground_height(self, x_world: Any, z_world: Any) -> Any:
        return self._heightfield.world_height(x_world, z_world, self._frame)
