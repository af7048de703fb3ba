"""What a compiled CUDA kernel asks of the machine, read from its cubin file without any CUDA tool.

A cubin is an ELF file: each kernel has a section of machine code, `.text.NAME`, instructions of 16 bytes
whose lowest 9 bits say what they do, and attributes in `.nv.info` (registers, stack) and `.nv.shared.NAME`.
Stack is memory outside the chip: registers that did not fit (spills) or arrays with a moving index.
"""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

REGISTER_COUNT, FRAME_SIZE = 0x2F, 0x11
"""Attributes of `.nv.info`: registers of a thread, bytes of its stack frame."""

INSTRUCTION_BYTES = 16

CLASSES = {
    "float": (0x020, 0x021, 0x023, 0x008, 0x009, 0x00A, 0x00B),
    "special": (0x108, 0x102),
    "double": (0x028, 0x029, 0x02A, 0x02B),
    "global load": (0x181,),
    "global store": (0x186,),
    "atomic": (0x1A8, 0x1A9, 0x18C, 0x18E),
    "shared": (0x184, 0x188),
    "local": (0x183, 0x187),
    "barrier": (0x11D,),
    "control": (0x141, 0x142, 0x144, 0x145, 0x146, 0x147, 0x148, 0x14D, 0x150, 0x118),
}
"""Opcodes by class: sums, products, comparisons; reciprocals and roots; and so on. The rest are integers."""

BARRIER = CLASSES["barrier"][0]
PADDING = 0x118


@dataclass(frozen=True)
class CompiledKernel:
    """One kernel of a cubin."""

    name: str
    registers: int
    """Per thread."""
    stack: int
    """Bytes per thread outside the chip."""
    shared: int
    """Bytes per block."""
    opcodes: tuple[int, ...]
    """Lowest 9 bits of each instruction, in the order of the code, without padding at the end."""

    @property
    def spills(self) -> int:
        """Instructions that read or write the stack."""
        return sum(opcode in CLASSES["local"] for opcode in self.opcodes)

    def mix(self) -> dict[str, int]:
        """Number of instructions by class."""
        counts = Counter(_class_of(opcode) for opcode in self.opcodes)
        return {name: counts[name] for name in (*CLASSES, "integer")}

    def phases(self) -> list[tuple[int, ...]]:
        """The instructions between the barriers, in the order of the code."""
        phases: list[list[int]] = [[]]
        for opcode in self.opcodes:
            phases[-1].append(opcode)
            if opcode == BARRIER:
                phases.append([])
        return [tuple(phase) for phase in phases]


MULTIPROCESSOR = {80: 164 * 1024, 90: 228 * 1024}
"""Shared memory of a multiprocessor [bytes] by compute capability (CUDA C programming guide, table 27)."""

REGISTERS, THREADS, BLOCKS = 65536, 2048, 32
"""Of a multiprocessor of compute capability 8.0 and 9.0."""


def blocks_at_once(kernel: CompiledKernel, architecture: int, threads: int = 256) -> int:
    """Blocks of so many threads that a multiprocessor can hold at once.

    Registers are dealt to warps in units of 256, shared memory to blocks in units of 1024 bytes, one of which
    the system keeps (where the cubin does not count it already).
    """
    warps = -(-threads // 32)
    by_registers = REGISTERS // (warps * (-(-kernel.registers * 32 // 256) * 256))
    own = kernel.shared + (1024 if architecture < 90 else 0)
    by_shared = MULTIPROCESSOR[architecture] // max(1, -(-own // 1024) * 1024)
    return min(by_registers, by_shared, THREADS // threads, BLOCKS)


def _class_of(opcode: int) -> str:
    return next((name for name, opcodes in CLASSES.items() if opcode in opcodes), "integer")


@dataclass(frozen=True)
class _Section:
    name: str
    begin: int
    size: int
    info: int


def _sections(blob: bytes) -> list[_Section]:
    (table,) = struct.unpack_from("<Q", blob, 0x28)
    entry, count, names = struct.unpack_from("<HHH", blob, 0x3A)
    headers = [struct.unpack_from("<IIQQQQIIQQ", blob, table + k * entry) for k in range(count)]
    text = headers[names][4]
    found = []
    for header in headers:
        at = text + header[0]
        name = blob[at : blob.index(b"\0", at)].decode()
        found.append(_Section(name, header[4], header[5], header[7]))
    return found


def _attributes(blob: bytes, section: _Section) -> Iterator[tuple[int, int, int]]:
    """Attribute, symbol and value of each sized entry."""
    at, end = section.begin, section.begin + section.size
    while at < end:
        form, attribute, size = struct.unpack_from("<BBH", blob, at)
        if form == 4:
            if attribute in (REGISTER_COUNT, FRAME_SIZE):
                yield attribute, *struct.unpack_from("<II", blob, at + 4)
            at += size
        at += 4


def read_cubin(file: Path) -> list[CompiledKernel]:
    """The kernels of a cubin file, by name.

    Args:
        file: machine code of compute capability 7.0 or newer.

    Raises:
        ValueError: when the file is not a cubin.
    """
    blob = file.read_bytes()
    if blob[:4] != b"\x7fELF":
        raise ValueError(f"{file} is not a cubin file.")
    sections = _sections(blob)
    values: dict[int, dict[int, int]] = {}
    for section in sections:
        if section.name == ".nv.info":
            for attribute, symbol, value in _attributes(blob, section):
                values.setdefault(symbol, {})[attribute] = value
    shared = {
        s.name.removeprefix(".nv.shared."): s.size for s in sections if s.name.startswith(".nv.shared.")
    }
    kernels = []
    for section in sections:
        if section.name.startswith(".text."):
            name = section.name.removeprefix(".text.")
            mine = values.get(section.info & 0xFFFFFF, {})
            code = struct.unpack_from(f"<{section.size // 8}Q", blob, section.begin)[::2]
            opcodes = [word & 0x1FF for word in code]
            while opcodes and opcodes[-1] in (PADDING, 0x147):
                opcodes.pop()
            kernels.append(
                CompiledKernel(
                    name=_plain(name),
                    registers=mine.get(REGISTER_COUNT, 0),
                    stack=mine.get(FRAME_SIZE, 0),
                    shared=shared.get(name, 0),
                    opcodes=tuple(opcodes),
                )
            )
    return sorted(kernels, key=lambda kernel: kernel.name)


def _plain(name: str) -> str:
    """A kernel's name without what Warp adds to it."""
    return name.removesuffix("_cuda_kernel_forward").rpartition("_")[0]
