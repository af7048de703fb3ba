import pytest

from solver_service.errors import DeviceError
from solver_service.numerics import free_memory
from solver_service.runs.placement import HEADROOM, LocalPlacement

GB = 10**9


def placement(**free: int) -> LocalPlacement:
    return LocalPlacement(lambda: {name.replace("_", ":"): size * GB for name, size in free.items()})


def test_the_emptiest_card_that_fits_is_taken() -> None:
    cards = placement(cpu=64, cuda_0=10, cuda_1=40, cuda_2=20)

    assert cards.place("auto", lambda name: 15 * GB) == "cuda:1"


def test_what_fits_no_card_is_computed_on_the_processor() -> None:
    cards = placement(cpu=64, cuda_0=10)

    assert cards.place("auto", lambda name: 15 * GB) == "cpu"
    assert placement(cpu=64).place("auto", lambda name: 15 * GB) == "cpu"


def test_the_host_may_need_more_than_the_card() -> None:
    cards = placement(cpu=4, cuda_0=10)

    assert cards.place("auto", lambda name: 5 * GB) == "cuda:0"


def test_what_fits_nowhere_is_refused_with_all_numbers() -> None:
    with pytest.raises(DeviceError, match=r"15\.00 GB on cpu, which has 8\.00 GB free; 15\.00 GB on cuda:0"):
        placement(cpu=8, cuda_0=10).place("auto", lambda name: 15 * GB)


def test_some_room_is_left_beside_the_run() -> None:
    exact = LocalPlacement(lambda: {"cpu": int(HEADROOM * GB)})
    assert exact.place("cpu", lambda name: GB) == "cpu"
    with pytest.raises(DeviceError, match="does not fit"):
        LocalPlacement(lambda: {"cpu": int(0.99 * HEADROOM * GB)}).place("cpu", lambda name: GB)


def test_a_pinned_run_goes_nowhere_else() -> None:
    with pytest.raises(DeviceError, match="on cpu, which has"):
        placement(cpu=8, cuda_0=100).place("cpu", lambda name: 15 * GB)
    with pytest.raises(DeviceError, match="'cuda:7' is not there"):
        placement(cpu=8).place("cuda:7", lambda name: GB)


def test_this_machine_knows_its_free_memory() -> None:
    free = free_memory()

    assert free["cpu"] > 10**8
    assert all(size >= 0 for size in free.values())
