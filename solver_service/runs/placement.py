"""On which device a run is computed: where it fits, and where most memory is free.

`Placement` is what a worker asks; `LocalPlacement` answers for the devices of one machine. Placement over
several machines is another implementation of the same question.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

from solver_service.errors import DeviceError
from solver_service.numerics import free_memory, pick_device

HEADROOM = 1.1
"""What must be free over what the table of allocations says: kernels, copies of frames and states."""
GB = 1e9


class Placement(Protocol):
    """Chooses the device of a run."""

    def place(self, wish: str, needed: Callable[[str], int]) -> str:
        """Name of the device to compute on.

        Args:
            wish: "auto", or the device that the run is pinned to.
            needed: memory that a run needs on a device [bytes].

        Raises:
            DeviceError: it fits nowhere, or not where it is pinned to.
        """


class LocalPlacement:
    """The devices of this machine.

    Args:
        free: gives the free memory of every device by its name [bytes], `cpu` among them.
    """

    def __init__(self, free: Callable[[], Mapping[str, int]] = free_memory) -> None:
        self._free = free

    def place(self, wish: str, needed: Callable[[str], int]) -> str:
        """As `Placement.place`: where a pinned run fits, else the emptiest card, else the CPU."""
        free = self._free()
        names = [pick_device(wish)] if wish != "auto" else list(free)
        fits = [name for name in names if HEADROOM * needed(name) <= free.get(name, 0)]
        if not fits:
            told = "; ".join(
                f"{needed(name) / GB:.2f} GB on {name}, which has {free.get(name, 0) / GB:.2f} GB free"
                for name in names
            )
            raise DeviceError(f"The run does not fit: it needs {told}.")
        cards = [name for name in fits if name != "cpu"]
        return max(cards, key=lambda name: free[name]) if cards else fits[0]
