"""A viewer far away: what it asks is answered although something large is on its way to it."""

import asyncio
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from bench.shaped_link import Link, shaped_link
from bench.slosh import write_slosh_case

SIDE = 600
LINK = Link(bytes_per_s=300_000.0, delay_s=0.05)


@contextmanager
def far_away(service: ServiceProcess, link: Link) -> Iterator[str]:
    """The address of a service over a link."""
    loop, ends, ports = asyncio.new_event_loop(), asyncio.Event(), []
    ready = threading.Event()

    async def relay() -> None:
        async with shaped_link("127.0.0.1", int(service.http.rpartition(":")[2]), link) as port:
            ports.append(port)
            ready.set()
            await ends.wait()

    thread = threading.Thread(target=loop.run_until_complete, args=(relay(),))
    thread.start()
    assert ready.wait(10.0)
    try:
        yield f"ws://127.0.0.1:{ports[0]}/v1/stream"
    finally:
        loop.call_soon_threadsafe(ends.set)
        thread.join()
        loop.close()


@pytest.mark.slow
def test_an_answer_overtakes_the_terrain_on_a_slow_link(tmp_path: Path) -> None:
    case = str(write_slosh_case(tmp_path / "slosh", SIDE, SIDE, 1000.0, 5.0))
    with ServiceProcess(tmp_path / "data", cases=[case], threads=2) as service:
        with ServiceClient(service) as client:
            run = str(client.do(protocol.StartRun, case=case, paused=True)["run"])
        with far_away(service, LINK) as service.url, ServiceClient(service) as far:
            far.do(protocol.GetTerrain, run=run)
            time.sleep(0.3)
            far.send(protocol.ListRuns(id=far.session.next_id()))
            first = far.until(lambda event: isinstance(event, protocol.RunList | protocol.TerrainReceived))
            assert isinstance(first, protocol.RunList), "the answer stood behind the terrain"
