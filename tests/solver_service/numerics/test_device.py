"""Devices by name, and kernels that compile without a GPU."""

import pytest

from solver_service.numerics import DeviceError, device_names, pick_device, warm_kernels
from solver_service.numerics.device import compile_for_cuda


def test_a_device_that_is_not_there_is_refused_with_those_that_are():
    with pytest.raises(DeviceError, match=r"'cuda:97' is not there; available are auto, cpu"):
        pick_device("cuda:97")


def test_auto_is_the_first_gpu_or_the_cpu():
    names = device_names()
    assert pick_device("auto") == (names[1] if len(names) > 1 else "cpu")


def test_warm_kernels_are_loaded_at_once_the_second_time():
    warm_kernels("cpu", with_oracle=True)
    assert warm_kernels("cpu", with_oracle=True) < 2.0


@pytest.mark.parametrize("architecture", [80, 90])
def test_every_cuda_kernel_compiles_ahead_without_a_gpu(architecture, tmp_path):
    files = compile_for_cuda(architecture, tmp_path)
    assert {file.suffix for file in files} == {".cubin"}
    code = b"".join(file.read_bytes() for file in files)
    for kernel in (
        b"step_active_tiles",
        b"begin_step",
        b"list_active_tiles",
        b"quantise_depth",
        b"record_gauges",
    ):
        assert kernel in code


def test_a_compiler_that_fails_is_named_with_its_words(monkeypatch):
    def fail(device):
        raise Exception("CPU kernel build failed with error code 1")

    from solver_service.numerics import device

    monkeypatch.setattr(device.ROWS_MODULE, "load", fail)
    with pytest.raises(DeviceError, match=r"warp_rows do not compile for cpu: .*error code 1"):
        warm_kernels("cpu")
