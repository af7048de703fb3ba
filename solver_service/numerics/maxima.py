"""The largest values since the start; the step kernels widen them (see `conservative_update`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from solver_service.numerics.fields import NEVER, FieldStore, FloatRaster


@dataclass(frozen=True)
class Maxima:
    """The largest values since the start, each taken after every step; rasters [nrows, ncols]."""

    h: npt.NDArray[np.float32]
    """Depth [m]."""
    time_of_max: npt.NDArray[np.float32]
    """Time of the largest depth [s], NaN where it stayed dry."""
    speed: npt.NDArray[np.float32]
    """Speed [m/s], where h > 0.05 m."""
    unit_discharge: npt.NDArray[np.float32]
    """Depth times speed [m2/s]."""
    hazard: npt.NDArray[np.float32]
    """UK hazard rating h (speed + 0.5) + debris factor."""
    arrival_time: npt.NDArray[np.float32]
    """First time deeper than `depth_arrival` [s], NaN where never."""
    wet_duration: npt.NDArray[np.float32]
    """Time deeper than `depth_arrival` in all [s]."""
    rise_rate_max: npt.NDArray[np.float32]
    """Fastest rise of the depth in one step, where deeper than `depth_arrival` [m/s]."""
    arrival_by_class: dict[float, npt.NDArray[np.float32]]
    """First time deeper than each of the parameter `arrival_depths` [s], NaN where never, by depth [m]."""


def begin_maxima(store: FieldStore, h: FloatRaster, depth_arrival: float) -> None:
    """Set the maxima to those of the present state, whose depth is `h` [m]."""
    u, v = store.read("u"), store.read("v")
    speed = np.where(h > 0.05, np.sqrt(u * u + v * v), np.float32(0.0))
    arrived = h > depth_arrival
    hazard = h * (speed + np.float32(0.5)) + np.where(h > 0.25, np.float32(1.0), np.float32(0.5))
    store.write("h_max", h)
    store.write("h_max_time", np.zeros_like(h))
    store.write("speed_max", speed)
    store.write("discharge_max", h * speed)
    store.write("hazard_max", np.where(arrived, hazard, np.float32(0.0)))
    store.write("arrival", np.where(arrived, np.float32(0.0), np.float32(NEVER)))
    store.write("wet_since", np.where(arrived, np.float32(-1.0), np.float32(0.0)))
    store.write("rise_rate_max", np.zeros_like(h))
    depths = np.array(store.arrival_depths, np.float32)[:, None, None]
    store.write_class_arrival(np.where(h > depths, np.float32(0.0), np.float32(NEVER)))


def end_wet_spells(store: FieldStore, time: float, depth_arrival: float) -> None:
    """Let cells that are no deeper than `depth_arrival` [m] count as dry from `time` [s] on."""
    since = store.read("wet_since")
    ended = (since < 0.0) & (store.read("h") <= depth_arrival)
    store.write("wet_since", np.where(ended, since + np.float32(time) + np.float32(1.0), since))


def read_maxima(store: FieldStore, time: float, depth_dry: float) -> Maxima:
    """Host copies of the maxima at `time` [s]; what never got deeper than `depth_dry` [m] has no time."""
    h, since = store.read("h"), store.read("wet_since")
    h_max, arrival, time_of_max = store.read("h_max"), store.read("arrival"), store.read("h_max_time")
    grew = h > h_max  # rain and sources raise the water after the step
    h_max = np.maximum(h_max, h)
    time_of_max = np.where(grew, np.float32(time), time_of_max)
    nan = np.float32(np.nan)
    return Maxima(
        h=h_max,
        time_of_max=np.where(h_max > depth_dry, time_of_max, nan),
        speed=store.read("speed_max"),
        unit_discharge=store.read("discharge_max"),
        hazard=store.read("hazard_max"),
        arrival_time=np.where(arrival < NEVER, arrival, nan),
        wet_duration=np.where(since < 0.0, (since + np.float32(time)) + np.float32(1.0), since),
        rise_rate_max=store.read("rise_rate_max"),
        arrival_by_class={
            depth: np.where(times < NEVER, times, nan)
            for depth, times in zip(store.arrival_depths, store.read_class_arrival(), strict=True)
        },
    )
