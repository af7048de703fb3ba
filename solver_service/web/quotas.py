"""How much each token takes of the service, looked at before anything is allocated.

Whoever owns a token is charged for its runs, whatever its connection; the holders of the token file are one
owner. A start counts from the moment it is allowed until its run stands in the tree, so that of two
starts at once only one takes the last place. Lives on one event loop.
"""

from __future__ import annotations

import time
from collections import Counter, defaultdict, deque
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass

from solver_service.errors import QuotaError
from solver_service.numerics import MemoryOptions, allocation_table, device_bytes
from solver_service.runs import Run, RunRegistry, RunStatus
from solver_service.runs.run_status import ACTIVE
from solver_service.web.auth import Access
from solver_service.web.token_limits import NAMES, TokenLimits
from solver_service.web.token_store import TokenStore

WINDOW_S = 1.0
"""Time over which edits are counted."""
LARGEST_OPTIONS = MemoryOptions(rain=True, infiltration=True, infiltration_zones=True)

WORDS = {
    "max_runs": "runs kept",
    "max_cells": "cells computed at the same time",
    "max_gpu_bytes": "bytes of GPU memory",
    "max_disk_bytes": "bytes on disk",
    "max_edits_per_s": "edits within a second",
    "max_viewers": "open streams",
}


@dataclass(frozen=True)
class Claim:
    """What is allowed to an owner and not taken yet.

    Attributes:
        owner: id of the token; nothing for the token file.
        runs: runs that are being made.
        cells: their cells.
        gpu_bytes: their memory on a GPU [bytes].
        disk_bytes: room for something that is being written [bytes].
    """

    owner: str
    runs: int = 0
    cells: int = 0
    gpu_bytes: int = 0
    disk_bytes: int = 0


class Quotas:
    """What each owner takes, and what it may.

    Attributes:
        refusals: how often each limit refused something.
    """

    def __init__(
        self,
        defaults: TokenLimits,
        tokens: TokenStore,
        registry: RunRegistry,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Nobody takes anything yet.

        Args:
            defaults: the limits of the settings, for the token file and for tokens that say nothing.
            tokens: the tokens and their own limits.
            registry: the runs.
            clock: gives the time now [s].
        """
        self.refusals: Counter[str] = Counter(dict.fromkeys(NAMES, 0))
        self._defaults = defaults
        self._tokens = tokens
        self._registry = registry
        self._clock = clock
        self._claims: list[Claim] = []
        self._edits: defaultdict[str, deque[float]] = defaultdict(deque)
        self._disk_sources: list[Callable[[str], int]] = []

    def limits(self, owner: str) -> TokenLimits:
        """What an owner may take.

        Raises:
            AccessError: its token is not known.
            StoreError: the tokens cannot be read.
        """
        if not owner:
            return self._defaults
        return self._tokens.known(owner).limits.over(self._defaults)

    def count_disk(self, source: Callable[[str], int]) -> None:
        """Let something else than runs count as room on the disk; `source` gives its bytes by owner."""
        self._disk_sources.append(source)

    # what is asked before something is allocated

    @asynccontextmanager
    async def start(self, access: Access, case: str, device: str) -> AsyncIterator[None]:
        """Allow a run of a case, and keep its place until the block ends.

        Args:
            access: who asks.
            case: name of the case; one that is not offered takes nothing, for it is refused anyway.
            device: the device asked for.

        Raises:
            QuotaError: the owner would take more than it may.
        """
        offered = self._registry.case(case)
        shape = (offered.nrows, offered.ncols) if offered is not None else (0, 0)
        claim = self._claim(owner_of(access), shape, device, runs=1)
        async with self._held(claim):
            yield

    @asynccontextmanager
    async def branch(self, access: Access, run: Run, keep_parent: bool) -> AsyncIterator[None]:
        """Allow a child of a run, and keep its place until the block ends; see `start`."""
        claim = self._claim(owner_of(access), _shape(run), run.record.device, runs=1)
        frees = not keep_parent and run.record.owner == claim.owner
        async with self._held(claim, in_place_of=run if frees else None):
            yield

    @asynccontextmanager
    async def resume(self, run: Run) -> AsyncIterator[None]:
        """Allow a run to go on, at the cost of its owner; see `start`."""
        claim = self._claim(run.record.owner, _shape(run), run.record.device, runs=0)
        async with self._held(claim, in_place_of=run):
            yield

    @asynccontextmanager
    async def disk(self, access: Access, size: int) -> AsyncIterator[None]:
        """Allow something of so many bytes to be written, and keep its room until the block ends.

        What is kept for good after that counts by a source of `count_disk`.
        """
        async with self._held(Claim(owner_of(access), disk_bytes=size)):
            yield

    def edit(self, access: Access, count: int) -> None:
        """Allow so many changes of edits now.

        Raises:
            QuotaError: they are too many within a second; none of them counts.
        """
        owner = owner_of(access)
        now = self._clock()
        past = self._edits[owner]
        while past and now - past[0] >= WINDOW_S:
            past.popleft()
        self._check(owner, "max_edits_per_s", len(past) + count)
        past.extend([now] * count)

    def view(self, access: Access, others: int) -> None:
        """Allow a stream beside others of the same owner.

        Raises:
            QuotaError: one more is too many.
        """
        self._check(owner_of(access), "max_viewers", others + 1)

    # what is taken

    async def disk_bytes(self, owner: str) -> int:
        """Room on the disk that an owner takes [bytes]."""
        stored = await self._registry.stored_bytes()
        own = sum(each.size for each in stored if each.owner == owner)
        return own + sum(source(owner) for source in self._disk_sources)

    def _claim(self, owner: str, shape: tuple[int, int], device: str, runs: int) -> Claim:
        on_gpu = _is_gpu(device, self._registry.pool.devices)
        return Claim(owner, runs, shape[0] * shape[1], _gpu_bytes(shape) if on_gpu else 0)

    @asynccontextmanager
    async def _held(self, claim: Claim, in_place_of: Run | None = None) -> AsyncIterator[None]:
        limit = self.limits(claim.owner).max_disk_bytes
        used = 0 if limit is None else await self.disk_bytes(claim.owner)
        with self._kept(claim, used, in_place_of):  # without a wait from here to the claim
            yield

    @contextmanager
    def _kept(self, claim: Claim, disk_used: int, in_place_of: Run | None) -> Iterator[None]:
        owner = claim.owner
        claims = [*(each for each in self._claims if each.owner == owner), claim]
        runs = [run for run in self._registry.tree if run.record.owner == owner]
        others = [run for run in runs if run is not in_place_of]
        gpu_bytes = sum(_gpu_bytes(_shape(run)) for run in others if _is_on_gpu(run))
        cells = sum(run.facts.grid.nrows * run.facts.grid.ncols for run in others if _computes(run))
        if claim.runs:
            self._check(owner, "max_runs", len(runs) + sum(each.runs for each in claims))
        if claim.cells:
            self._check(owner, "max_cells", cells + sum(each.cells for each in claims))
        if claim.gpu_bytes:
            self._check(owner, "max_gpu_bytes", gpu_bytes + sum(each.gpu_bytes for each in claims))
        # a run needs some room on the disk, however little
        disk = disk_used + sum(each.disk_bytes for each in claims) + (claim.cells > 0)
        self._check(owner, "max_disk_bytes", disk)
        self._claims.append(claim)
        try:
            yield
        finally:
            self._claims.remove(claim)

    def _check(self, owner: str, name: str, asked: int) -> None:
        allowed = getattr(self.limits(owner), name)
        if allowed is None or asked <= allowed:
            return
        self.refusals[name] += 1
        whose = f"token {owner}" if owner else "the token file"
        raise QuotaError(
            name, f"{asked} {WORDS[name]} are too many for {whose}; {allowed} are allowed ({name})"
        )


def owner_of(access: Access) -> str:
    """Who is charged: the id of the token, or nothing for the token file."""
    return access.token or ""


def _shape(run: Run) -> tuple[int, int]:
    return run.facts.grid.nrows, run.facts.grid.ncols


def _computes(run: Run) -> bool:
    """Whether a run computes, or goes on by itself as soon as there is room."""
    return run.status in ACTIVE or run.lacks_room


def _is_on_gpu(run: Run) -> bool:
    waits = run.status is RunStatus.PAUSED and run.worker is not None and run.worker.run == run.run
    return run.record.device.startswith("cuda") and (_computes(run) or waits)


def _is_gpu(device: str, devices: tuple[str, ...]) -> bool:
    return device.startswith("cuda") or (device == "auto" and any(d.startswith("cuda") for d in devices))


def _gpu_bytes(shape: tuple[int, int]) -> int:
    """What a solver of this grid takes of a GPU at most [bytes]."""
    return device_bytes(allocation_table(shape, LARGEST_OPTIONS, "cuda:0"), "cuda:0") if all(shape) else 0
