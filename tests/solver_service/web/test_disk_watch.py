"""The room of one owner against a real registry; through a service in `test_quotas`."""

import asyncio
import contextlib
from pathlib import Path

import pytest

from solver_service.runs import RunRegistry, RunStatus
from solver_service.web.disk_watch import halt_over_quota, watch_disk
from solver_service.web.quotas import Quotas
from solver_service.web.token_limits import TokenLimits
from solver_service.web.token_store import TokenStore
from tests.end_to_end.dam_break import write_dam_break


@pytest.mark.parametrize(("allowed", "status"), [(1, RunStatus.PAUSED), (1 << 40, RunStatus.RUNNING)])
def test_only_what_computes_beyond_its_room_is_paused(
    tmp_path: Path, allowed: int, status: RunStatus
) -> None:
    case = str(write_dam_break(tmp_path / "dam-break"))

    async def watch() -> None:
        registry = RunRegistry(tmp_path / "data", cases=(case,), spare_workers=0, threads=1)
        await registry.open()
        tokens = TokenStore(tmp_path / "data")
        try:
            quotas = Quotas(TokenLimits(max_disk_bytes=allowed), tokens, registry)
            run = await registry.control.start("dam-break", 1e6)
            async with asyncio.timeout(60.0):
                while not run.frames:
                    await asyncio.sleep(0.02)
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(0.3):
                    await watch_disk(quotas, registry, 0.05)
            assert run.status is status
            assert ("(max_disk_bytes)" in run.reason) == (status is RunStatus.PAUSED)
            await halt_over_quota(quotas, registry)  # what waits already is left alone
            assert run.status is status
        finally:
            await registry.close()
            tokens.close()

    asyncio.run(watch())
