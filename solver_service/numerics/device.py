"""Which device computes, and its kernels compiled before they are needed."""

from __future__ import annotations

import contextlib
import importlib
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import warp as wp

from solver_service.errors import DeviceError
from solver_service.numerics.warp_modules import (
    CUDA_MODULES,
    ROWS_MODULE,
    STEP_MODULE,
    STRUCTURE_MODULE,
    SUPPORT_MODULE,
)

LOCK_POLL_S = 0.2


def device_names() -> list[str]:
    """Devices that can compute here, `cpu` first."""
    wp.init()
    return ["cpu", *(device.alias for device in wp.get_cuda_devices())]


def free_memory() -> dict[str, int]:
    """Memory that is free on each device [bytes], by its name; that of the host for `cpu`."""
    wp.init()
    cards = {device.alias: int(device.free_memory) for device in wp.get_cuda_devices()}
    return {"cpu": int(psutil.virtual_memory().available), **cards}


def pick_device(wish: str = "auto") -> str:
    """Name of the device to compute on.

    Args:
        wish: `auto` (CUDA if there is one, else the CPU), `cpu`, `cuda` or `cuda:N`.

    Raises:
        DeviceError: when the device named is not there, naming those that are.
    """
    names = device_names()
    if wish == "auto":
        return names[1] if len(names) > 1 else "cpu"
    name = "cuda:0" if wish == "cuda" else wish
    if name not in names:
        raise DeviceError(f"The device {wish!r} is not there; available are {', '.join(['auto', *names])}.")
    return name


@contextlib.contextmanager
def _compiler_lock() -> Iterator[None]:
    """One compiling process at a time: concurrent cold starts on one cache folder can crash."""
    wp.init()
    folder = Path(wp.config.kernel_cache_dir or ".")
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "fev-compile.lock").open("a+b") as lock:
        if sys.platform == "win32":
            import msvcrt

            while True:
                try:
                    msvcrt.locking(lock.fileno(), msvcrt.LK_NBLCK, 1)
                    break
                except OSError:
                    time.sleep(LOCK_POLL_S)
        else:
            import fcntl

            fcntl.flock(lock.fileno(), fcntl.LOCK_EX)
        yield


def import_kernels() -> None:
    """Let every kernel file, that is every module named `..._kernels`, register its kernels."""
    for file in sorted(Path(__file__).parent.glob("*_kernels.py")):
        importlib.import_module(f"solver_service.numerics.{file.stem}")


def warm_kernels(device: str = "auto", *, with_oracle: bool = False) -> float:
    """Compile and load the kernels that a run on the device uses; returns the seconds it took.

    Args:
        device: as for `pick_device`.
        with_oracle: on the CPU, also the scalar step that the row engine is tested against.

    Raises:
        DeviceError: when the device is not there or its kernels do not compile.
    """
    import_kernels()
    name = pick_device(device)
    began = time.perf_counter()
    modules = [SUPPORT_MODULE, ROWS_MODULE] if name == "cpu" else [SUPPORT_MODULE, STEP_MODULE]
    if name == "cpu" and with_oracle:
        modules.append(STEP_MODULE)
    _load(modules, name)
    return time.perf_counter() - began


def load_structure_kernels(device: str) -> None:
    """Compile and load the kernels that only models with structures, breaches or sections need.

    Args:
        device: name of a device that is there.

    Raises:
        DeviceError: when the kernels do not compile.
    """
    import_kernels()
    _load([STRUCTURE_MODULE], device)


def _load(modules: list[wp.Module], device: str) -> None:
    with _compiler_lock():
        for module in modules:
            try:
                loaded = module.load(wp.get_device(device))
            except Exception as error:  # Warp raises the base class when a compiler fails
                raise DeviceError(
                    f"The kernels of {module.name} do not compile for {device}: {error}."
                ) from error
            if loaded is None:
                raise DeviceError(f"The kernels of {module.name} cannot be loaded on {device}.")


def thread_count(wish: int | None) -> int:
    """Threads to use on the CPU: the wish, else every core this process may use."""
    if wish is not None:
        return wish
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def compile_for_cuda(architecture: int, folder: Path) -> list[Path]:
    """Compile every kernel of CUDA devices to cubin files; needs no GPU.

    Args:
        architecture: compute capability, 90 for sm_90.
        folder: where the files go.

    Returns:
        The cubin files.
    """
    import_kernels()
    for module in CUDA_MODULES:
        wp.compile_aot_module(module, arch=architecture, module_dir=folder, use_ptx=False)
    return sorted(folder.glob("*.cubin"))
