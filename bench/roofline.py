"""How fast a step could be at most: bytes and operations per cell-step against what the machine can do.

Bytes are counted from the arrays that a step reads and writes, each once; neighbours come from the cache.
Instructions are counted in the machine code of the CUDA step, phase by phase, times the turns a lane takes:
at most, since both variants of the load are counted, and what is done once per block as if once per tile.
The row loops run the same functions, each once per cell and the face function twice, so that the floating
point operations of a cell-step are known from there.

A ceiling is what memory or arithmetic alone would allow. The rate of a core is measured, in CPU time; no CUDA
rate is measured by this bench (`python -m bench gpu` does, where there is a device).
"""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bench.cubin import CompiledKernel
from bench.floods import wavy_lake
from bench.kernels import STEP, compiled_kernels
from solver_service.numerics import ShallowWaterSolver, SolverParams
from solver_service.numerics.fields import MAXIMA_NAMES, STATE_NAMES

FLOAT = 4

PHASES = {
    "begin": 1.0,
    "load": 4 / 8,
    "predict": 10 / 8,
    "faces": 9 / 8,
    "update": 1.0,
    "end": 1 / 8,
}
"""Phases of the step of a tile between its barriers, and the turns each takes of the 8 warps of a block."""


@dataclass(frozen=True)
class Gpu:
    """What a GPU can do at most, by its data sheet; bandwidth as copies reach it."""

    name: str
    architecture: int
    multiprocessors: int
    clock: float
    """Boost clock [Hz]."""
    bandwidth: float
    """[bytes/s]."""

    @property
    def issue(self) -> float:
        """Instructions of single lanes per second: four warps a cycle on each multiprocessor."""
        return self.multiprocessors * 4 * 32 * self.clock


GPUS = (Gpu("A100", 80, 108, 1.41e9, 1.7e12), Gpu("H200", 90, 132, 1.98e9, 4.3e12))


@dataclass(frozen=True)
class StepCost:
    """What one cell-step costs."""

    instructions: float
    """Of a lane of a GPU, at most."""
    operations: float
    """Sums, products, comparisons, divisions and roots, as a CPU does them."""


def step_cost(kernel: CompiledKernel) -> StepCost:
    """Cost of a cell-step, counted in the compiled step.

    Raises:
        ValueError: when the phases of the kernel are not those known here.
    """
    phases = kernel.phases()
    if len(phases) != len(PHASES) + 1:
        raise ValueError(f"{kernel.name} has {len(phases)} phases; {len(PHASES) + 1} are known.")
    instructions = sum(len(phase) * turns for phase, turns in zip(phases, PHASES.values(), strict=False))
    arithmetic = (CompiledKernel(kernel.name, 0, 0, 0, phase).mix() for phase in phases[2:5])
    operations = sum(mix["float"] + mix["special"] for mix in arithmetic)
    return StepCost(instructions, float(operations))


def bytes_per_cell_step(widened: int) -> int:
    """Memory traffic of a cell-step: state, bed, roughness and maxima, so many of which grow.

    Args:
        widened: maxima that are written back.
    """
    return FLOAT * (2 * len(STATE_NAMES) + 2 + len(MAXIMA_NAMES) + widened)


def cpu_bytes_per_cell_step() -> int:
    """The same for row loops: all maxima are written, and the new state is read before it is written."""
    return bytes_per_cell_step(len(MAXIMA_NAMES)) + FLOAT * len(STATE_NAMES)


def copy_bandwidth(length: int) -> float:
    """Bytes read and written per second by one thread that copies so many floats, more than a cache holds."""
    source = np.ones(length, np.float32)
    target = np.empty_like(source)
    best = float("inf")
    for _ in range(5):
        began = time.perf_counter()
        np.copyto(target, source)
        best = min(best, time.perf_counter() - began)
    return 2 * source.nbytes / best


def vector_operations() -> float:
    """Floating point operations per second of one core: two vectors a cycle at the nominal clock."""
    info = Path("/proc/cpuinfo")
    text = info.read_text(encoding="utf-8") if info.exists() else ""
    clocks = [float(value) for value in re.findall(r"cpu MHz\s*: ([\d.]+)", text)]
    lanes = 16 if " avx512f" in text else 8 if " avx2" in text else 4
    return 2 * lanes * 1e6 * max(clocks, default=2500.0)


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Costs, ceilings and the measured rate of one core."""
    cost = {}
    for gpu in GPUS[-1:] if smoke else GPUS:
        kernel = next(k for k in compiled_kernels(gpu.architecture) if k.name == STEP)
        cost[gpu.architecture] = one = step_cost(kernel)
        least, most = bytes_per_cell_step(0), bytes_per_cell_step(len(MAXIMA_NAMES))
        arithmetic, memory = gpu.issue / one.instructions, gpu.bandwidth / most
        yield {
            "figure": f"ceiling_{gpu.name}",
            "value": min(arithmetic, memory),
            "unit": "cell-steps/s",
            "instructions_per_cell_step": round(one.instructions),
            "bytes_per_cell_step": [least, most],
            "arithmetic_ceiling": arithmetic,
            "memory_ceiling": memory,
            "limit": "arithmetic" if arithmetic < memory else "memory",
            "measured": None,
        }
    side = 256 if smoke else 1024
    model, water = wavy_lake(side)
    solver = ShallowWaterSolver(model, SolverParams(threads=1))
    solver.set_water(*water)
    solver.advance_to(6.0)
    best = float("inf")
    for _ in range(1 if smoke else 4):
        steps, began = solver.step_count, time.process_time()
        solver.advance_to(solver.time + 6.0)
        best = min(best, (time.process_time() - began) / (solver.step_count - steps))
    operations = cost[90].operations
    arithmetic, memory = (
        vector_operations() / operations,
        copy_bandwidth(1 << (23 if smoke else 26)) / cpu_bytes_per_cell_step(),
    )
    yield {
        "figure": "ceiling_cpu_core",
        "value": min(arithmetic, memory),
        "unit": "cell-steps/s",
        "operations_per_cell_step": round(operations),
        "bytes_per_cell_step": cpu_bytes_per_cell_step(),
        "arithmetic_ceiling": arithmetic,
        "memory_ceiling": memory,
        "limit": "arithmetic" if arithmetic < memory else "memory",
        "measured": side * side / best,
    }
