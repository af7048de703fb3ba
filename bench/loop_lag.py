"""How late the event loop of a service is, as a client feels it: round trips of websocket pings.

The pings go from a process of their own (`python -m bench.loop_lag`), a hundred a second, so that what the
bench itself computes is not counted. A round trip holds the loop's lag and the way there and back, so it is
an upper bound of the lag.
"""

from __future__ import annotations

import asyncio
import json
import subprocess
import sys
from types import TracebackType

import numpy as np
from websockets.asyncio.client import connect

import protocol
from bench.service_process import ServiceProcess

INTERVAL_S = 0.01
PATIENCE_S = 30.0


class LoopLag:
    """Pings a service until the `with` block ends.

    Attributes:
        trips: the round trips [s]; filled when the block ends.
    """

    def __init__(self, service: ServiceProcess) -> None:
        self.trips: list[float] = []
        self._told = json.dumps({"url": service.url, "token": service.token})

    def __enter__(self) -> LoopLag:
        """Start to ping and wait for the first answer."""
        command = [sys.executable, "-m", "bench.loop_lag"]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(self._told + "\n")
        self._process.stdin.flush()
        if not self._process.stdout.readline():
            raise RuntimeError("the service answered no ping")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End, and take the round trips in."""
        try:
            answer, _ = self._process.communicate(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.communicate()
            raise
        self.trips = json.loads(answer)

    def quantile(self, percent: float) -> float:
        """A quantile of the round trips [s]."""
        return float(np.percentile(self.trips, percent))


async def _ping(url: str, token: str) -> None:
    """Ping until standard input closes, then tell the round trips."""
    trips: list[float] = []
    async with connect(
        url,
        subprotocols=[protocol.PROTOCOL_VERSION],  # type: ignore[list-item]
        additional_headers={"Authorization": f"Bearer {token}"},
        compression=None,
        max_size=protocol.limits.OUTBOUND_MAX_BYTES,
        ping_interval=None,
    ) as connection:
        await connection.send(protocol.ClientSession("loop lag").open(None))
        closed = asyncio.create_task(asyncio.to_thread(sys.stdin.read))
        reading = asyncio.create_task(_read_for_ever(connection))
        print("ready", flush=True)
        while not closed.done():
            trips.append(await (await connection.ping()))
            await asyncio.sleep(INTERVAL_S)
        reading.cancel()
    print(json.dumps(trips))


async def _read_for_ever(connection: object) -> None:
    """Take what the service tells everybody."""
    async for _ in connection:  # type: ignore[attr-defined]
        pass


if __name__ == "__main__":
    told = json.loads(sys.stdin.readline())
    asyncio.run(_ping(told["url"], told["token"]))
