"""What keeping velocity and maxima beside the depth costs: CPU time for each step and frame, and bytes.

The flood is that of the bench of the stream. CPU seconds are those of this process: a step on as many threads
as there are cores, everything else on one. Maxima go with every fourth frame; their share is given for that.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

from bench.slosh import write_slosh_case
from protocol import CHANNEL_FIELDS, BlockLayout, FrameEncoder, choose_depth_scale
from solver_service.numerics import ShallowWaterSolver
from solver_service.runs.channels import MAXIMA_EVERY
from solver_service.runs.quantised_frame import QuantisedFrame, pack_channels
from solver_service.scenario import load_case

FULL = (1949, 2113)
SMOKE = (128, 128)
FRAMES = 12
SMOKE_FRAMES = 3
INTERVAL = 2.0

T = TypeVar("T")


class _Cpu:
    """CPU seconds by what they were spent on."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    def spend(self, what: str, call: Callable[[], T]) -> T:
        begun = time.process_time()
        done = call()
        self.seconds[what] = self.seconds.get(what, 0.0) + time.process_time() - begun
        return done


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """CPU time and bytes of frames and of each channel."""
    nrows, ncols = SMOKE if smoke else FULL
    frames = SMOKE_FRAMES if smoke else FRAMES
    with tempfile.TemporaryDirectory(prefix="fev-bench-") as folder:
        case = load_case(str(write_slosh_case(Path(folder) / "slosh", nrows, ncols, 100.0, INTERVAL)))
    solver = ShallowWaterSolver(case.model, case.params, "cpu")
    solver.set_water(case.initial_h)
    solver.advance_to(INTERVAL)
    layout, depth_wet = BlockLayout(nrows, ncols), case.params.depth_dry
    encoder, scale = FrameEncoder(layout), choose_depth_scale(float(solver.depth().max()))
    cpu, sizes = _Cpu(), {"frame": 0, "velocity": 0, "maxima": 0}
    before, wet = solver.step_count, 0
    for index in range(frames):
        cpu.spend("steps", lambda index=index: solver.advance_to((index + 2) * INTERVAL))  # type: ignore[misc]
        q, states = cpu.spend("frame", lambda: solver.quantise(scale, depth_wet))
        packed = cpu.spend(
            "frame",
            lambda water=(q, states), index=index: encoder.encode(  # type: ignore[misc]
                "r", index, solver.time, 0, water, scale=scale
            ),
        )
        sizes["frame"] += len(packed)
        wet += int((q > 0).sum())
        for name, read in (("velocity", solver.velocity_fields), ("maxima", solver.maximum_fields)):
            fields = cpu.spend(f"{name} read-out", read)
            named = dict(zip(CHANNEL_FIELDS[name], fields, strict=True))  # type: ignore[index]
            frame = QuantisedFrame("r", index, solver.time, 0, q, states, scale, channels={name: named})  # type: ignore[dict-item]
            done = cpu.spend(f"{name} packing", lambda frame=frame: pack_channels(frame, layout))  # type: ignore[misc]
            sizes[name] += len(done[name])
    steps = (solver.step_count - before) / frames
    about = {
        "cells": nrows * ncols,
        "wet_share": round(wet / (frames * nrows * ncols), 3),
        "steps_a_frame": round(steps, 1),
        "frames": frames,
    }
    for what, seconds in cpu.seconds.items():
        share = 1.0 / MAXIMA_EVERY if what.startswith("maxima") else 1.0
        yield {
            "figure": f"{what.replace(' ', '_').replace('-', '_')}_cpu",
            "value": round(1e3 * seconds / frames, 2),
            "unit": "ms a frame that has it",
            "ms_a_step": round(1e3 * share * seconds / frames / steps, 3),
            "share_of_steps": round(share * seconds / cpu.seconds["steps"], 4),
            **about,
        }
    for what, size in sizes.items():
        share = 1.0 / MAXIMA_EVERY if what == "maxima" else 1.0
        yield {
            "figure": f"{what}_bytes",
            "value": round(size / frames / 1e3, 1),
            "unit": "kB a frame that has it",
            "kB_a_frame": round(share * size / frames / 1e3, 1),
            **about,
        }
