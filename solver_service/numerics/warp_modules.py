"""The Warp modules that the kernels live in, and their options.

Few modules mean a short cold start, since each costs one compiler run. `step` holds the fused step of the
scalar and CUDA engines, `rows` the SIMD step of CPUs (its native code must never reach NVRTC), `structures`
what only models with weirs, culverts, pumps or breaches need, `support` everything else.

`fuse_fp` is off: without contraction a face that two cells compute apart gives both the same float, so that
mass is conserved, and every engine gives the same bits.
"""

import platform

import warp as wp

wp.config.log_level = max(wp.config.log_level, 30)


def _module(name: str) -> wp.Module:
    module = wp.get_module(name)
    module.options.update({"enable_backward": False, "fuse_fp": False, "fast_math": False})
    return module


STEP_MODULE = _module("solver_service.numerics.warp_step")
ROWS_MODULE = _module("solver_service.numerics.warp_rows")
if platform.machine() in ("x86_64", "AMD64"):
    # Clang halves AVX-512 vectors unless told otherwise; whole ones make the row loops 10 % faster.
    ROWS_MODULE.options["cpu_compiler_flags"] = (
        f"{wp.config.cpu_compiler_flags or ''} -mprefer-vector-width=512"
    )
SUPPORT_MODULE = _module("solver_service.numerics.warp_support")
STRUCTURE_MODULE = _module("solver_service.numerics.warp_structures")

CUDA_MODULES = (SUPPORT_MODULE, STEP_MODULE, STRUCTURE_MODULE)
"""All that CUDA devices may be given: every module but that of the native rows."""
