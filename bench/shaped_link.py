"""A slow link in the way of a connection: a relay that passes so many bytes a second, late, with stalls.

Between the ends lies what a network has: the queue of a bottleneck, which is small, and bytes under way for
the delay. When it is full the sender feels it, as it would on a real link. A stall stands for a lost packet:
nothing passes until it is sent again. Works as any user on any system, while `tc netem` needs root and a
kernel module.
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass

CHUNK = 4096
QUEUE_BYTES = 32_768
SOCKET_BYTES = 16_384
"""Buffer of the system towards the sender; the default would hide a slow link behind megabytes."""


@dataclass(frozen=True)
class Link:
    """What a link can do.

    Attributes:
        bytes_per_s: rate of each direction.
        delay_s: time under way, one way [s].
        stall_every_s: time between two stalls [s]; 0 for none.
        stall_s: how long a stall lasts [s].
    """

    bytes_per_s: float
    delay_s: float = 0.0
    stall_every_s: float = 0.0
    stall_s: float = 0.0


@asynccontextmanager
async def shaped_link(host: str, port: int, link: Link) -> AsyncIterator[int]:
    """Relay connections to an address over a link.

    Args:
        host: address of the far end.
        port: its port.
        link: what lies between.

    Yields:
        The port on this machine to connect to.
    """
    relays: set[asyncio.Task[None]] = set()

    def relay(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        relays.add(asyncio.create_task(_relay(reader, writer, (host, port), link)))

    server = await asyncio.start_server(relay, "127.0.0.1", 0, limit=CHUNK)
    try:
        yield server.sockets[0].getsockname()[1]
    finally:
        server.close()
        for task in relays:
            task.cancel()
        await asyncio.gather(*relays, return_exceptions=True)


async def _relay(
    reader: asyncio.StreamReader, writer: asyncio.StreamWriter, far: tuple[str, int], link: Link
) -> None:
    """One connection until either end closes it."""
    raw = socket.create_connection(far)
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SOCKET_BYTES)
    far_reader, far_writer = await asyncio.open_connection(sock=raw, limit=CHUNK)
    ways = [
        asyncio.create_task(_carry(far_reader, writer, link)),
        asyncio.create_task(_carry(reader, far_writer, link)),
    ]
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for way in ways:
            way.cancel()
        for end in (writer, far_writer):
            end.close()


async def _carry(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, link: Link) -> None:
    """One direction: into the air at the rate, out of it after the delay."""
    loop = asyncio.get_running_loop()
    under_way: asyncio.Queue[tuple[float, bytes]] = asyncio.Queue()
    room = asyncio.Semaphore(max(1, int((QUEUE_BYTES + link.bytes_per_s * link.delay_s) // CHUNK)))

    async def depart() -> None:
        free_at = loop.time()
        stall_at = free_at + link.stall_every_s
        chunk = b"first"
        while chunk:
            await room.acquire()
            chunk = await reader.read(CHUNK)
            free_at = max(free_at, loop.time()) + len(chunk) / link.bytes_per_s
            if link.stall_every_s and free_at >= stall_at:
                free_at += link.stall_s
                stall_at = free_at + link.stall_every_s
            under_way.put_nowait((free_at + link.delay_s, chunk))

    async def arrive() -> None:
        chunk = b"first"
        while chunk:
            at, chunk = await under_way.get()
            await asyncio.sleep(at - loop.time())
            writer.write(chunk)
            await writer.drain()
            room.release()

    ways = [asyncio.create_task(depart()), asyncio.create_task(arrive())]
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_EXCEPTION)
    finally:
        for way in ways:
            way.cancel()
        await asyncio.gather(*ways, return_exceptions=True)  # an end that is gone is no error of the link
