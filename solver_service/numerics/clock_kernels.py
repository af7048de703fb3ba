"""The clock: time step, time and landing on the target, decided on the device in float64.

    dt = min(cfl dx / max(|u| + c, |v| + c), dt_max)

clipped only to land exactly on the target; when less than two steps remain they are made equal, so that no
sliver of a step follows. `choose_dt` is the same arithmetic for the row engine, which keeps its clock on
the host.
"""

from __future__ import annotations

import warp as wp

from solver_service.numerics.warp_modules import SUPPORT_MODULE

CLOCK_TIME = wp.constant(0)
CLOCK_TARGET = wp.constant(1)
CLOCK_DT = wp.constant(2)
CLOCK_BEFORE = wp.constant(3)
CLOCK_STABLE = wp.constant(4)
CLOCK_LENGTH = 5

COUNT_STEPS = wp.constant(0)
COUNT_LIMIT = wp.constant(1)
COUNT_FAILED = wp.constant(2)
COUNT_LENGTH = 3


def choose_dt(
    time: float, target: float, wave: float, courant: float, dt_max: float
) -> tuple[float, float, float]:
    """Time step [s], new time [s] and the step that stability alone allows [s].

    Args:
        time: present time [s].
        target: time to land on [s].
        wave: largest wave speed [m/s].
        courant: cfl dx [m].
        dt_max: largest step [s].
    """
    stable = min(courant / wave, dt_max) if wave > 0.0 else dt_max
    left = target - time
    if stable >= left:
        return left, target, stable
    dt = 0.5 * left if 2.0 * stable > left else stable
    return dt, time + dt, stable


@wp.kernel(module=SUPPORT_MODULE)
def begin_step(
    courant: wp.float64,
    dt_max: wp.float64,
    dt_min: wp.float64,
    # outputs
    rest_wave: wp.array(dtype=wp.float32),
    wave_slots: wp.array(dtype=wp.float32),
    clock: wp.array(dtype=wp.float64),
    counts: wp.array(dtype=wp.int32),
):
    """Set dt from the largest wave speed, sleeping tiles included; move the clock; dt = 0 at the target."""
    time = clock[CLOCK_TIME]
    target = clock[CLOCK_TARGET]
    clock[CLOCK_DT] = wp.float64(0.0)
    clock[CLOCK_BEFORE] = time
    if time < target and counts[COUNT_FAILED] == 0:
        wave = wp.max(rest_wave[0], rest_wave[1])
        rest_wave[1] = 0.0
        for k in range(wave_slots.shape[0]):
            wave = wp.max(wave, wave_slots[k])
        stable = dt_max
        if wave > 0.0:
            stable = wp.min(courant / wp.float64(wave), dt_max)
        clock[CLOCK_STABLE] = stable
        if stable < dt_min:
            counts[COUNT_FAILED] = 1
        else:
            for k in range(wave_slots.shape[0]):
                wave_slots[k] = 0.0
            left = target - time
            dt = stable
            after = time + dt
            if stable >= left:
                dt = left
                after = target
            elif wp.float64(2.0) * stable > left:
                dt = wp.float64(0.5) * left
                after = time + dt
            clock[CLOCK_DT] = dt
            clock[CLOCK_TIME] = after
            counts[COUNT_STEPS] = counts[COUNT_STEPS] + 1


@wp.kernel(module=SUPPORT_MODULE)
def decide_to_go_on(
    clock: wp.array(dtype=wp.float64),
    counts: wp.array(dtype=wp.int32),
    # outputs
    go_on: wp.array(dtype=wp.int32),
):
    """`go_on` is 1 while the target is ahead, nothing failed, and steps are left for this launch."""
    more = clock[CLOCK_TIME] < clock[CLOCK_TARGET] and counts[COUNT_FAILED] == 0
    go_on[0] = wp.where(more and counts[COUNT_STEPS] < counts[COUNT_LIMIT], 1, 0)
