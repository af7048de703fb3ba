import asyncio
import time
from collections.abc import Awaitable, Callable

import pytest

from bench.shaped_link import Link, shaped_link

Use = Callable[[asyncio.StreamReader, asyncio.StreamWriter], Awaitable[float]]


async def echo(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    while data := await reader.read(65536):
        writer.write(data)
        await writer.drain()
    writer.close()


async def over(link: Link, use: Use) -> float:
    """Use a connection to an echo over a link."""
    server = await asyncio.start_server(echo, "127.0.0.1", 0)
    async with server, shaped_link("127.0.0.1", server.sockets[0].getsockname()[1], link) as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        try:
            return await use(reader, writer)
        finally:
            writer.close()


async def time_of_100_kb(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> float:
    sent = bytes(range(250)) * 400
    begun = time.perf_counter()
    writer.write(sent)
    assert await reader.readexactly(len(sent)) == sent
    return time.perf_counter() - begun


async def time_of_a_byte(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> float:
    begun = time.perf_counter()
    writer.write(b"x")
    assert await reader.readexactly(1) == b"x"
    return time.perf_counter() - begun


@pytest.mark.parametrize(
    ("link", "use", "least", "most"),
    [
        (Link(1e9), time_of_100_kb, 0.0, 0.3),
        (Link(200_000.0), time_of_100_kb, 0.5, 1.2),
        (Link(1e9, delay_s=0.2), time_of_a_byte, 0.4, 0.7),
        (Link(1_000_000.0, stall_every_s=0.05, stall_s=0.2), time_of_100_kb, 0.3, 2.0),
    ],
)
def test_a_link_passes_every_byte_at_its_rate_after_its_delay_and_stalls(
    link: Link, use: Use, least: float, most: float
) -> None:
    assert least <= asyncio.run(over(link, use)) < most


def test_a_sender_feels_that_a_link_is_slow() -> None:
    async def accepted_at_once(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> float:
        writer.write(bytes(20_000_000))
        await asyncio.sleep(0.3)
        transport = writer.transport
        left = float(transport.get_write_buffer_size())
        transport.abort()
        return left

    assert asyncio.run(over(Link(100_000.0), accepted_at_once)) > 10_000_000
