"""`fev-solver doctor` and `fev-solver warmup`: is this machine ready to compute?"""

from __future__ import annotations

import json
import os
import platform
import sys
import time
from dataclasses import asdict
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from solver_service.cli.server_checks import check_server

LIBRARIES = (
    "flood-emergency-visualizer",
    "warp-lang",
    "numpy",
    "scipy",
    "rasterio",
    "pyproj",
    "netCDF4",
    "zarr",
    "fastapi",
    "uvicorn",
    "websockets",
    "msgpack",
    "msgspec",
    "zstandard",
)


def tell_machine(json_line: bool, config: Path | None = None) -> bool:
    """Print versions, devices, memory and folders, and whether a server can work here.

    Args:
        json_line: one JSON object instead of lines.
        config: the settings file of the server, if any.

    Returns:
        Whether everything that a server needs is good.
    """
    facts = machine_facts()
    checks = check_server(config, os.environ)
    is_good = all(check.is_good for check in checks)
    if json_line:
        print(json.dumps({**facts, "checks": [asdict(check) for check in checks]}), flush=True)
        return is_good
    for name, value in facts.items():
        if isinstance(value, dict):
            print(f"{name}:")
            for key, item in value.items():
                print(f"  {key:<28}{item}")
        else:
            print(f"{name:<30}{value}")
    for check in checks:
        print(f"{'ok' if check.is_good else 'BAD':<4}{check.name:<14}{check.words}")
    return is_good


def machine_facts() -> dict[str, Any]:
    """Facts of this machine by name; nothing secret."""
    import psutil
    import warp as wp

    from solver_service.numerics import device_names
    from solver_service.scenario import list_cases

    wp.config.log_level = wp.LOG_ERROR
    devices = {}
    for name in device_names():
        device = wp.get_device(name)
        devices[name] = device.name if device.is_cuda else platform.processor() or platform.machine()
    return {
        "python": f"{platform.python_version()} ({sys.executable})",
        "system": platform.platform(),
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count(),
        "memory free": f"{psutil.virtual_memory().available / 2**30:.1f} GiB",
        "kernel cache": str(wp.config.kernel_cache_dir),
        "FEV_DATA_HOME": os.environ.get("FEV_DATA_HOME", "not set"),
        "cases": ", ".join(list_cases()),
        "devices": devices,
        "libraries": {name: _version(name) for name in LIBRARIES},
    }


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "not installed"


def warm_up(device: str) -> None:
    """Compile what a run needs, by compiling it and taking one step of a puddle.

    Raises:
        DeviceError: the device is absent, or its kernels do not compile.
    """
    import warp as wp

    from solver_service.numerics import FloodModel, ShallowWaterSolver, pick_device, warm_kernels

    wp.config.log_level = wp.LOG_ERROR
    name = pick_device(device)
    began = time.perf_counter()
    warm_kernels(name)
    shape = (64, 64)
    solver = ShallowWaterSolver(FloodModel(1.0, np.zeros(shape, np.float32), 0.03), device=name)
    water = np.zeros(shape, np.float32)
    water[:, :32] = 1.0
    solver.set_water(water)
    solver.advance_to(0.1)
    solver.quantise(0.001, 0.001)
    print(f"kernels for {name} are ready ({time.perf_counter() - began:.1f} s)")
