"""Devices by name, and kernels that compile without a GPU."""

import importlib
from pathlib import Path

import pytest
import warp as wp

from bench.cubin import blocks_at_once, read_cubin
from solver_service import numerics
from solver_service.numerics import DeviceError, device_names, pick_device, warm_kernels
from solver_service.numerics.device import compile_for_cuda
from solver_service.numerics.step_kernels import step_active_tiles
from solver_service.numerics.tile_step_kernels import BLOCKS_PER_MULTIPROCESSOR, LANES
from solver_service.numerics.warp_modules import CUDA_MODULES, ROWS_MODULE, STEP_MODULE


def test_a_device_that_is_not_there_is_refused_with_those_that_are():
    with pytest.raises(DeviceError, match=r"'cuda:97' is not there; available are auto, cpu"):
        pick_device("cuda:97")


def test_auto_is_the_first_gpu_or_the_cpu():
    names = device_names()
    assert pick_device("auto") == (names[1] if len(names) > 1 else "cpu")


def test_warm_kernels_are_loaded_at_once_the_second_time():
    warm_kernels("cpu", with_oracle=True)
    assert warm_kernels("cpu", with_oracle=True) < 2.0


def kernels_of_the_solver():
    """Module and name of every kernel that any module of the solver defines."""
    files = sorted(Path(numerics.__file__).parent.glob("*.py"))
    modules = [importlib.import_module(f"solver_service.numerics.{file.stem}") for file in files]
    kernels = [value for module in modules for value in vars(module).values() if isinstance(value, wp.Kernel)]
    return {(kernel.module.name, kernel.key) for kernel in kernels}


def test_every_kernel_belongs_to_a_module_that_is_compiled_ahead():
    known = {module.name for module in (*CUDA_MODULES, ROWS_MODULE)}
    assert {module for module, _ in kernels_of_the_solver()} == known


@pytest.mark.parametrize("architecture", [80, 90])
def test_every_cuda_kernel_compiles_ahead_without_a_gpu_and_the_step_keeps_to_its_registers(
    architecture, tmp_path
):
    files = compile_for_cuda(architecture, tmp_path)
    assert {file.suffix for file in files} == {".cubin"}
    compiled = {kernel.name: kernel for file in files for kernel in read_cubin(file)}
    wanted = {name for module, name in kernels_of_the_solver() if module != ROWS_MODULE.name}
    assert set(compiled) == wanted
    step = compiled["step_listed_tiles"]
    assert (step.stack, step.spills) == (0, 0)
    assert step.registers <= 64
    assert blocks_at_once(step, architecture, LANES) >= BLOCKS_PER_MULTIPROCESSOR


def test_a_step_with_too_few_registers_is_seen_to_spill(tmp_path):
    module = wp.get_module("tests.cramped_step")
    module.options.update(STEP_MODULE.options)
    cramped = wp.Kernel(step_active_tiles.func, "cramped", module, options={"cuda_max_registers": 64})
    wp.compile_aot_module(module, arch=90, module_dir=tmp_path, use_ptx=False)
    (kernel,) = read_cubin(next(tmp_path.glob("*.cubin")))
    assert kernel.name == cramped.key
    assert kernel.stack > 0
    assert kernel.spills > 0


def test_a_compiler_that_fails_is_named_with_its_words(monkeypatch):
    def fail(device):
        raise Exception("CPU kernel build failed with error code 1")

    from solver_service.numerics import device

    monkeypatch.setattr(device.ROWS_MODULE, "load", fail)
    with pytest.raises(DeviceError, match=r"warp_rows do not compile for cpu: .*error code 1"):
        warm_kernels("cpu")
