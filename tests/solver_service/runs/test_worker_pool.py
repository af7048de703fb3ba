import asyncio
from pathlib import Path

from solver_service.runs.worker_messages import WorkerSettings
from solver_service.runs.worker_pool import WorkerPool
from solver_service.store import DataFolder, RunDatabase


def settings(root: Path) -> WorkerSettings:
    database = RunDatabase(DataFolder(root).database)
    epoch = database.begin_epoch()
    database.close()
    return WorkerSettings(root, epoch, 1 << 20, 60.0, 1, "cpu")


def pool_in(root: Path, spares: int = 0) -> WorkerPool:
    return WorkerPool(settings(root), spares, lambda *_: None, lambda _: None, lambda _: False)


def test_runs_that_ask_at_the_same_moment_get_different_workers(tmp_path: Path) -> None:
    async def ask() -> None:
        pool = pool_in(tmp_path)
        workers = await asyncio.gather(*(pool.take(f"r{k}", "case", "cpu") for k in range(3)))
        assert len({worker.pid for worker in workers}) == 3
        assert [worker.run for worker in workers] == ["r0", "r1", "r2"]
        await pool.close()

    asyncio.run(ask())


def test_a_worker_that_was_told_to_end_is_given_to_nobody(tmp_path: Path) -> None:
    async def ask() -> None:
        pool = pool_in(tmp_path)
        first = await pool.take("r1", "case", "cpu")
        pool.release(first)
        assert first.is_ending
        second = await pool.take("r2", "case", "cpu")
        assert second is not first
        assert second.is_ready
        await pool.close()

    asyncio.run(ask())
