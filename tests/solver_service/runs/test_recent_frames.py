import asyncio

import pytest

from solver_service.errors import StoreError
from solver_service.runs.recent_frames import RecentFrames
from solver_service.store import FrameRecord


def record(index: int) -> FrameRecord:
    return FrameRecord("r", index, float(index), 0, 0, "0.segment", 100 * index, 100, 7)


class Disk:
    def __init__(self) -> None:
        self.read: list[int] = []
        self.fails = False

    async def __call__(self, wanted: FrameRecord) -> bytes:
        self.read.append(wanted.index)
        await asyncio.sleep(0.01)
        if self.fails:
            raise StoreError("the frame is damaged")
        return bytes([wanted.index]) * wanted.size


def test_many_who_want_one_frame_have_it_read_once() -> None:
    disk = Disk()

    async def all_at_once() -> list[bytes]:
        frames = RecentFrames(disk)
        await asyncio.gather(*(frames.get(record(1)) for _ in range(64)))
        return await asyncio.gather(*(frames.get(record(1)) for _ in range(64)))

    assert set(asyncio.run(all_at_once())) == {b"\x01" * 100}
    assert disk.read == [1]


def test_the_frame_wanted_least_lately_goes_first() -> None:
    disk = Disk()

    async def wander() -> None:
        frames = RecentFrames(disk, most_bytes=250)
        for index in (1, 2, 1, 3, 1, 2):
            await frames.get(record(index))

    asyncio.run(wander())
    assert disk.read == [1, 2, 3, 2]


def test_a_frame_that_cannot_be_read_is_told_to_all_and_tried_again() -> None:
    disk = Disk()

    async def fail_then_read() -> bytes:
        frames = RecentFrames(disk)
        disk.fails = True
        outcomes = await asyncio.gather(*(frames.get(record(1)) for _ in range(3)), return_exceptions=True)
        assert [str(outcome) for outcome in outcomes] == ["the frame is damaged"] * 3
        disk.fails = False
        return await frames.get(record(1))

    assert asyncio.run(fail_then_read()) == b"\x01" * 100
    assert disk.read == [1, 1]


def test_who_leaves_does_not_take_the_reading_from_the_others() -> None:
    disk = Disk()

    async def leave() -> bytes:
        frames = RecentFrames(disk)
        first = asyncio.ensure_future(frames.get(record(1)))
        second = asyncio.ensure_future(frames.get(record(1)))
        await asyncio.sleep(0)
        first.cancel()
        with pytest.raises(asyncio.CancelledError):
            await first
        return await second

    assert asyncio.run(leave()) == b"\x01" * 100
    assert disk.read == [1]


def test_a_frame_larger_than_all_that_may_be_kept_is_not_kept() -> None:
    disk = Disk()

    async def twice() -> None:
        frames = RecentFrames(disk, most_bytes=50)
        await frames.get(record(1))
        await frames.get(record(1))

    asyncio.run(twice())
    assert disk.read == [1, 1]
