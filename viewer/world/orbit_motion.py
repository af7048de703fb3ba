"""Smooth, time-based camera motion: held keys, drags with inertia, wheel, flights.

Every motion is a velocity v that relaxes to a wanted velocity w with time constant tau, so over a span dt

    v(dt) = w + (v - w) exp(-dt / tau)
    x(dt) = x + w dt + (v - w) tau (1 - exp(-dt / tau))

which is exact: one long picture moves the camera as far as many short ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum

from viewer.world.camera import Camera, GroundHeight
from viewer.world.coordinates import Point

__all__ = ["Flight", "Move", "OrbitMotion"]

_TIME_CONSTANT_S = 0.12
_PAN_SPEED = 0.9
"""Held pan: distances to the target a second."""
_ORBIT_SPEED = math.radians(75.0)
"""Held orbit [rad/s]."""
_ZOOM_SPEED = 1.2
"""Held zoom: natural logarithm of the distance a second."""
_DRAG_SAMPLE_S = 0.08
"""Span over which the velocity of a drag is averaged [s]."""


class Move(Enum):
    """What a held key does, as (axis, sign)."""

    PAN_RIGHT = ("pan_right", 1.0)
    PAN_LEFT = ("pan_right", -1.0)
    PAN_FORWARD = ("pan_forward", 1.0)
    PAN_BACK = ("pan_forward", -1.0)
    ORBIT_RIGHT = ("azimuth", 1.0)
    ORBIT_LEFT = ("azimuth", -1.0)
    ORBIT_UP = ("elevation", 1.0)
    ORBIT_DOWN = ("elevation", -1.0)
    ZOOM_IN = ("zoom", -1.0)
    ZOOM_OUT = ("zoom", 1.0)


_HELD_SPEED = {
    "pan_right": _PAN_SPEED,
    "pan_forward": _PAN_SPEED,
    "azimuth": _ORBIT_SPEED,
    "elevation": _ORBIT_SPEED,
    "zoom": _ZOOM_SPEED,
}
_AXES = tuple(_HELD_SPEED)


@dataclass(frozen=True)
class Flight:
    """A timed move from one pose to another that starts and ends at rest."""

    start: Camera
    end: Camera
    duration: float
    """[s], > 0."""

    def at(self, time: float) -> Camera:
        """The pose a time after the start [s]; the end pose from the duration on."""
        u = min(max(time / self.duration, 0.0), 1.0)
        if u >= 1.0:
            return self.end
        s = u * u * u * (u * (6.0 * u - 15.0) + 10.0)
        a, b = self.start, self.end

        def mix(p: float, q: float) -> float:
            return p + s * (q - p)

        turn = math.remainder(b.azimuth - a.azimuth, 2.0 * math.pi)
        return replace(
            a,
            target=(
                mix(a.target[0], b.target[0]),
                mix(a.target[1], b.target[1]),
                mix(a.target[2], b.target[2]),
            ),
            distance=a.distance * (b.distance / a.distance) ** s,
            azimuth=math.remainder(a.azimuth + s * turn, 2.0 * math.pi),
            elevation=mix(a.elevation, b.elevation),
            fov_y=mix(a.fov_y, b.fov_y),
        )


class OrbitMotion:
    """What moves the camera between pictures; `advance` turns elapsed wall time into a new camera."""

    def __init__(self) -> None:
        """Begin at rest."""
        self._held: set[Move] = set()
        self._velocity = dict.fromkeys(_AXES, 0.0)
        self._pending = dict.fromkeys(_AXES, 0.0)
        self._is_dragging = False
        self._anchor: Point | None = None
        self._flight: Flight | None = None
        self._flight_time = 0.0

    @property
    def is_moving(self) -> bool:
        """Whether the next picture will differ: False lets the window sleep."""
        return (
            self._flight is not None
            or self._is_dragging
            or bool(self._held)
            or any(abs(v) > 1e-4 for v in self._velocity.values())
            or any(self._pending.values())
        )

    def hold(self, move: Move) -> None:
        """A key went down."""
        self._flight = None
        self._anchor = None
        self._held.add(move)

    def release(self, move: Move) -> None:
        """A key came up."""
        self._held.discard(move)

    def release_all(self) -> None:
        """The window lost the keyboard."""
        self._held.clear()
        self._is_dragging = False

    def begin_drag(self) -> None:
        """A mouse button went down: whatever still coasts stops."""
        self._flight = None
        self._anchor = None
        self._is_dragging = True
        self._velocity = dict.fromkeys(_AXES, 0.0)

    def drag_orbit(self, dx: float, dy: float) -> None:
        """The mouse turned the view by a move given in picture heights (x right, y down)."""
        self._pending["azimuth"] += dx * math.pi
        self._pending["elevation"] += dy * math.pi

    def drag_pan(self, dx: float, dy: float, camera: Camera) -> None:
        """The mouse dragged the ground by a move given in picture heights (x right, y down)."""
        per_height = 2.0 * math.tan(0.5 * camera.fov_y)
        self._pending["pan_right"] -= dx * per_height
        # Seen at a slant the ground is foreshortened; near the horizon the gain is kept in bounds.
        self._pending["pan_forward"] += dy * per_height / max(math.sin(camera.elevation), 0.25)

    def end_drag(self) -> None:
        """The mouse button came up: the camera coasts on with the velocity of the drag."""
        self._is_dragging = False

    def scroll(self, steps: float, anchor: Point | None = None) -> None:
        """The wheel turned; one step toward the user multiplies the distance by about 1.16.

        Args:
            steps: notches toward the user.
            anchor: world point that keeps its place in the picture; None: the target does.
        """
        self._flight = None
        self._anchor = anchor
        self._velocity["zoom"] += 0.15 * steps / _TIME_CONSTANT_S

    def fly_to(self, start: Camera, end: Camera, duration: float = 1.2) -> None:
        """Begin a flight; any key or drag ends it."""
        self._velocity = dict.fromkeys(_AXES, 0.0)
        self._flight = Flight(start, end, duration)
        self._flight_time = 0.0

    def advance(
        self, camera: Camera, wall_dt: float, ground: GroundHeight | None = None, clearance: float = 5.0
    ) -> Camera:
        """The camera after a span of wall time.

        Args:
            camera: the camera now.
            wall_dt: wall time since the last picture [s].
            ground: height of the ground in the world; if given, the target glides along it and the eye
                stays above.
            clearance: least height of the eye above the ground [m].
        """
        if self._flight is not None:
            self._flight_time += wall_dt
            camera = self._flight.at(self._flight_time)
            if self._flight_time >= self._flight.duration:
                self._flight = None
        else:
            camera = self._moved(camera, self._displacement(wall_dt))
            if ground is not None:
                camera = camera.with_target(_glide(camera.target, ground, wall_dt))
        return camera if ground is None else camera.kept_above(ground, clearance)

    def _displacement(self, wall_dt: float) -> dict[str, float]:
        wanted = dict.fromkeys(_AXES, 0.0)
        for move in self._held:
            axis, sign = move.value
            wanted[axis] += sign * _HELD_SPEED[axis]
        decay = math.exp(-wall_dt / _TIME_CONSTANT_S)
        moved: dict[str, float] = {}
        for axis in _AXES:
            w, v = wanted[axis], self._velocity[axis]
            moved[axis] = w * wall_dt + (v - w) * _TIME_CONSTANT_S * (1.0 - decay)
            self._velocity[axis] = w + (v - w) * decay
        if self._is_dragging:
            self._follow_drag(moved, wall_dt)
        return moved

    def _follow_drag(self, moved: dict[str, float], wall_dt: float) -> None:
        """While the button is down the camera goes where the mouse went; the mean velocity is kept."""
        fade = math.exp(-wall_dt / _DRAG_SAMPLE_S)
        for axis in _AXES:
            if axis == "zoom":
                continue
            moved[axis] = self._pending[axis]
            measured = self._pending[axis] / wall_dt if wall_dt > 0.0 else 0.0
            self._velocity[axis] = measured + (self._velocity[axis] - measured) * fade
            self._pending[axis] = 0.0

    def _moved(self, camera: Camera, moved: dict[str, float]) -> Camera:
        before, camera = camera.distance, camera.zoomed(math.exp(moved["zoom"]))
        if self._anchor is not None:
            x, y, z = camera.target
            x0, y0, z0 = self._anchor
            f = camera.distance / before
            camera = camera.with_target((x0 + f * (x - x0), y0 + f * (y - y0), z0 + f * (z - z0)))
        camera = camera.orbited(moved["azimuth"], moved["elevation"])
        return camera.panned(moved["pan_right"] * camera.distance, moved["pan_forward"] * camera.distance)


def _glide(target: Point, ground: GroundHeight, wall_dt: float) -> Point:
    """The target drawn toward the ground below it."""
    height = float(ground(target[0], target[2]))
    nearer = height + (target[1] - height) * math.exp(-wall_dt / (3.0 * _TIME_CONSTANT_S))
    return (target[0], nearer, target[2])
