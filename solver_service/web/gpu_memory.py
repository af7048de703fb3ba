"""Memory of the GPUs of this machine, as their driver tells it; nothing where there is none."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import pynvml

LOG = logging.getLogger(__name__)


@dataclass(frozen=True)
class GpuMemory:
    """One GPU.

    Attributes:
        index: its number in the order of the driver.
        name: what it is.
        used_bytes: memory in use, also by others [bytes].
        total_bytes: memory it has [bytes].
    """

    index: int
    name: str
    used_bytes: int
    total_bytes: int


def gpu_memory() -> list[GpuMemory]:
    """All GPUs of this machine; none where there is no driver."""
    try:
        pynvml.nvmlInit()
    except pynvml.NVMLError as error:
        LOG.debug("no GPU is told of: %s", error)
        return []
    try:
        return [_memory_of(index) for index in range(pynvml.nvmlDeviceGetCount())]
    except pynvml.NVMLError as error:
        LOG.warning("the memory of the GPUs cannot be read: %s", error)
        return []
    finally:
        pynvml.nvmlShutdown()


def _memory_of(index: int) -> GpuMemory:
    handle = pynvml.nvmlDeviceGetHandleByIndex(index)
    memory = pynvml.nvmlDeviceGetMemoryInfo(handle)
    return GpuMemory(index, pynvml.nvmlDeviceGetName(handle), int(memory.used), int(memory.total))
