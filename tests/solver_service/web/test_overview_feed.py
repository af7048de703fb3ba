"""Watching the overview: whole, then differences; bounded whatever the watcher does; no cost without one."""

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any

import pytest

from solver_service.errors import RunError, StoreError
from solver_service.web import overview_feed
from solver_service.web.overview_feed import EventStream, OverviewFeed


class Counted:
    """An overview that changes when it is told to."""

    def __init__(self) -> None:
        self.now: dict[str, dict[str, Any]] = {"runs": {"r1": {"frames": 0}}, "events": {}}
        self.fails = False

    async def collect(self) -> dict[str, dict[str, Any]]:
        if self.fails:
            raise StoreError("the disk is gone")
        return {section: dict(rows) for section, rows in self.now.items()}


def decoded(event: bytes) -> Any:
    lines = event.decode().splitlines()
    assert lines[0] == "event: overview", event
    return json.loads(lines[1].removeprefix("data: "))


def always() -> bool:
    return True


def test_a_watcher_gets_all_at_first_and_then_what_changed() -> None:
    async def watched() -> None:
        source = Counted()
        feed = OverviewFeed(source.collect, interval_s=0.01)
        events = feed.events(always)
        assert decoded(await anext(events)) == {"set": {"runs": {"r1": {"frames": 0}}}, "gone": {}}
        source.now["runs"] = {"r1": {"frames": 0}, "r2": {"frames": 5}}
        assert decoded(await anext(events)) == {"set": {"runs": {"r2": {"frames": 5}}}, "gone": {}}
        source.now["runs"] = {"r2": {"frames": 6}}
        assert decoded(await anext(events)) == {
            "set": {"runs": {"r2": {"frames": 6}}},
            "gone": {"runs": ["r1"]},
        }
        late = feed.events(always)
        assert decoded(await anext(late)) == {"set": {"runs": {"r2": {"frames": 6}}}, "gone": {}}
        assert feed.watchers == 2
        await events.aclose()
        await late.aclose()
        assert feed.watchers == 0

    asyncio.run(watched())


def test_a_watcher_that_was_slow_gets_one_difference_and_no_backlog() -> None:
    async def watched() -> None:
        source = Counted()
        feed = OverviewFeed(source.collect, interval_s=0.005)
        events = feed.events(always)
        await anext(events)
        for frames in range(1, 20):
            source.now["runs"] = {"r1": {"frames": frames}}
            await asyncio.sleep(0.01)
        assert decoded(await anext(events))["set"]["runs"]["r1"]["frames"] >= 18
        await events.aclose()

    asyncio.run(watched())


def test_nothing_is_collected_while_nobody_watches() -> None:
    async def watched() -> None:
        feed = OverviewFeed(Counted().collect, interval_s=0.01)
        await asyncio.sleep(0.05)
        assert feed.looks == 0
        events = feed.events(always)
        await anext(events)
        await events.aclose()
        await asyncio.sleep(0.02)
        looks = feed.looks
        await asyncio.sleep(0.05)
        assert feed.looks == looks > 0

    asyncio.run(watched())


def test_silence_is_broken_by_a_comment_and_a_broken_look_by_the_next(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(overview_feed, "HEARTBEAT_S", 0.03)

    async def watched() -> None:
        source = Counted()
        feed = OverviewFeed(source.collect, interval_s=0.01)
        events = feed.events(always)
        await anext(events)
        assert (await anext(events)).startswith(b":")
        source.fails = True
        assert (await anext(events)).startswith(b":")
        source.fails, source.now["runs"] = False, {"r9": {}}
        assert decoded(await anext(events))["set"] == {"runs": {"r9": {}}}
        await events.aclose()

    asyncio.run(watched())


def test_a_token_that_ends_and_a_service_that_ends_are_told() -> None:
    async def watched() -> None:
        feed = OverviewFeed(Counted().collect, interval_s=0.01)
        holds = True
        events = feed.events(lambda: holds)
        await anext(events)
        holds = False
        assert b"revoked or has expired" in await anext(events)
        assert [event async for event in events] == []
        other = feed.events(always)
        await anext(other)
        closing = asyncio.create_task(feed.close())
        rest = [event async for event in other]
        await closing
        assert b"the service is ending" in rest[-1]
        assert feed.watchers == 0

    asyncio.run(watched())


def test_too_many_watchers_are_refused() -> None:
    async def watched() -> None:
        feed = OverviewFeed(Counted().collect, interval_s=0.01)
        crowd = [feed.events(always) for _ in range(overview_feed.MAX_WATCHERS)]
        for events in crowd:
            await anext(events)
        with pytest.raises(RunError, match="16 pages watch already"):
            feed.admit()
        for events in crowd:
            await events.aclose()
        feed.admit()

    asyncio.run(watched())


@pytest.mark.parametrize("how", ["stalls", "leaves"])
def test_a_page_that_stops_reading_or_leaves_is_dropped(how: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(overview_feed, "SEND_TIMEOUT_S", 0.05)

    async def watched() -> None:
        feed = OverviewFeed(Counted().collect, interval_s=0.01)
        sent: list[Any] = []
        gone = asyncio.Event()

        async def send(message: Any) -> None:
            sent.append(message)
            if message["type"] == "http.response.body":
                if how == "stalls":
                    await asyncio.Event().wait()
                gone.set()

        async def receive() -> dict[str, str]:
            await gone.wait()
            return {"type": "http.disconnect"}

        events: AsyncIterator[bytes] = feed.events(always)
        async with asyncio.timeout(5.0):
            await EventStream(events)({"type": "http"}, receive, send)
        assert feed.watchers == 0
        assert sent[0]["status"] == 200
        assert (b"content-type", b"text/event-stream; charset=utf-8") in sent[0]["headers"]
        assert not [name for name, _ in sent[0]["headers"] if name == b"content-length"]

    asyncio.run(watched())
