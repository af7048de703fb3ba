import pytest

from solver_service.numerics import device_names
from solver_service.web.gpu_memory import gpu_memory

HAS_GPU = any(name.startswith("cuda") for name in device_names())


@pytest.mark.skipif(HAS_GPU, reason="this machine has a GPU")
def test_a_machine_without_a_gpu_tells_none() -> None:
    assert gpu_memory() == []


@pytest.mark.gpu
@pytest.mark.skipif(not HAS_GPU, reason="this machine has no GPU")
def test_a_gpu_tells_what_it_has_and_what_is_taken() -> None:
    gpus = gpu_memory()
    assert gpus
    for gpu in gpus:
        assert gpu.name
        assert 0 < gpu.used_bytes <= gpu.total_bytes
