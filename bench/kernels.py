"""What every CUDA kernel asks of a multiprocessor, compiled for sm_80 and sm_90; needs no GPU.

One line per kernel and architecture; `value` is its registers. A floor is the most that the design allows.
"""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench.cubin import CompiledKernel, blocks_at_once, read_cubin
from solver_service.numerics.device import compile_for_cuda

ARCHITECTURES = (80, 90)
STEP = "step_listed_tiles"


@functools.cache
def compiled_kernels(architecture: int) -> list[CompiledKernel]:
    """Every kernel of CUDA devices, compiled for a compute capability."""
    with tempfile.TemporaryDirectory() as folder:
        return [
            kernel for file in compile_for_cuda(architecture, Path(folder)) for kernel in read_cubin(file)
        ]


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Registers, stack, shared memory, occupancy and instructions of each kernel."""
    for architecture in ARCHITECTURES[-1:] if smoke else ARCHITECTURES:
        for kernel in compiled_kernels(architecture):
            yield {
                "figure": f"sm_{architecture}_{kernel.name}",
                "value": kernel.registers,
                "unit": "registers",
                "floor": 64 if kernel.name == STEP else None,
                "stack_bytes": kernel.stack,
                "spill_instructions": kernel.spills,
                "shared_bytes": kernel.shared,
                "blocks_at_once": blocks_at_once(kernel, architecture),
                "instructions": {name: count for name, count in kernel.mix().items() if count},
            }
