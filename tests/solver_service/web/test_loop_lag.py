import asyncio
import contextlib
import time

from prometheus_client import CollectorRegistry

from solver_service.web.loop_lag import LoopLag


def test_a_call_that_blocks_the_loop_is_seen_as_lag() -> None:
    registry = CollectorRegistry()
    lag = LoopLag(registry)

    async def block() -> None:
        probe = asyncio.get_running_loop().create_task(lag.work(0.01))
        await asyncio.sleep(0.05)
        calm = registry.get_sample_value("fev_event_loop_lag_seconds_sum")
        time.sleep(0.3)  # what nobody should do on an event loop
        await asyncio.sleep(0.05)
        probe.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await probe
        blocked = registry.get_sample_value("fev_event_loop_lag_seconds_sum")
        assert calm is not None
        assert blocked is not None
        assert 0.25 < blocked - calm < 2.0
        fast = registry.get_sample_value("fev_event_loop_lag_seconds_bucket", {"le": "0.2"})
        count = registry.get_sample_value("fev_event_loop_lag_seconds_count")
        assert fast is not None
        assert fast < count

    asyncio.run(block())
