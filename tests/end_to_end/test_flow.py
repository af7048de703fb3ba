"""Slow clients, lost connections, several viewers."""

import contextlib
import socket
import time
from pathlib import Path

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed

import protocol
from bench import service_process
from bench.crowd import Crowd, Viewer
from bench.service_process import ServiceClient, ServiceProcess
from protocol import BlockLayout, FrameDecoder
from tests.end_to_end.dam_break import CELLS

LAST = 20
LAYOUT = BlockLayout(CELLS, CELLS)


@pytest.fixture(scope="module")
def run(service: ServiceProcess, case: str) -> str:
    with ServiceClient(service) as client:
        run = str(client.do(protocol.StartRun, case=case)["run"])
        client.do(protocol.Subscribe, run=run, credit=8)
        client.frame(run, LAST)
        return run


def test_no_frame_is_sent_beyond_the_credit(service: ServiceProcess, run: str) -> None:
    with ServiceClient(service, grants_credit=False) as client:
        client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=3)
        assert [client.first(protocol.Frame).index for _ in range(3)] == [0, 1, 2]
        with pytest.raises(TimeoutError):
            client.first(protocol.Frame, timeout_s=0.5)
        client.send(protocol.Credit(2))
        assert [client.first(protocol.Frame).index for _ in range(2)] == [3, 4]


def test_a_slow_viewer_that_follows_live_gets_the_newest_frame_and_can_decode_it(
    service: ServiceProcess, case: str
) -> None:
    with ServiceClient(service, grants_credit=False) as client:
        run = str(client.do(protocol.StartRun, case=case)["run"])
        client.do(protocol.Subscribe, run=run, from_index=0, mode="live", credit=1)
        decoder = FrameDecoder(LAYOUT)
        first = decoder.decode(client.first(protocol.Frame))
        client.first(protocol.RunChanged, lambda event: event.run.status == "finished")
        client.send(protocol.Credit(2))
        frame = client.first(protocol.Frame)
        if frame.is_key and frame.index != LAST:
            decoder.decode(frame)
            frame = client.first(protocol.Frame)
        newest = decoder.decode(frame)
        assert first.index < newest.index == LAST


def test_a_seek_fetches_any_frame_and_its_key_frame_before_it(service: ServiceProcess, run: str) -> None:
    with ServiceClient(service) as client:
        client.do(protocol.Subscribe, run=run, from_index=LAST, mode="replay", credit=2)
        decoder = FrameDecoder(LAYOUT)
        key = client.first(protocol.Frame)
        assert key.is_key
        decoder.decode(key)
        assert decoder.decode(client.first(protocol.Frame)).index == LAST
        client.do(protocol.Seek, run=run, index=7)
        sought = decoder.decode(client.first(protocol.Frame, lambda frame: frame.index == 7))
        assert sought.time == 35.0


def test_a_lost_connection_is_taken_up_without_a_gap(service: ServiceProcess, run: str) -> None:
    decoded = []
    with ServiceClient(service) as client:
        client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=2)
        decoder = FrameDecoder(LAYOUT)
        while len(decoded) < 9:
            decoded.append(decoder.decode(client.first(protocol.Frame)))
        client._connection.socket.shutdown(socket.SHUT_RDWR)
    resume = protocol.ResumePoint(run=run, last_index=8, revision=0)
    with ServiceClient(service, resume=resume) as client:
        assert client.first(protocol.RunChanged).run.run == run
        assert client.first(protocol.EditsChanged).revision == 0
        client.do(protocol.Subscribe, run=run, from_index=9, mode="replay", credit=2)
        decoder = FrameDecoder(LAYOUT)
        while decoded[-1].index < LAST:
            frame = decoder.decode(client.first(protocol.Frame))
            if frame.index > decoded[-1].index:
                decoded.append(frame)
    assert [frame.index for frame in decoded] == list(range(LAST + 1))
    with ServiceClient(service) as client:
        client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=8)
        decoder = FrameDecoder(LAYOUT)
        for frame in decoded:
            np.testing.assert_array_equal(decoder.decode(client.first(protocol.Frame)).q, frame.q)


IMPATIENT = """
from solver_service.web import server
server.PING_INTERVAL_S, server.PING_TIMEOUT_S = 0.5, 3.0
"""


def test_a_viewer_that_has_died_is_let_go_while_one_that_lives_stays(
    tmp_path: Path, case: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(service_process, "_SERVE", IMPATIENT + service_process._SERVE)
    log = tmp_path / "log"
    with (
        log.open("wb") as stderr,
        ServiceProcess(tmp_path / "data", stderr, cases=[case]) as service,
        ServiceClient(service) as alive,
    ):
        run = str(alive.do(protocol.StartRun, case=case, duration=1e5)["run"])
        with Crowd(service, run, [Viewer("dead", reads=False, credit=1)]) as crowd:
            dead = crowd.sessions["dead"]
            alive.do(protocol.Subscribe, run=run)
            ends = time.monotonic() + 30.0
            while any(fact["session"] == dead for fact in service.get("/v1/connections")):
                assert time.monotonic() < ends, "the service holds on to a dead viewer"
                alive.first(protocol.Frame)
        alive.do(protocol.StopRun, run=run)
    assert "Exception" not in log.read_text(encoding="utf-8")


def test_a_client_that_never_reads_neither_slows_a_run_nor_another_viewer(
    service: ServiceProcess, case: str
) -> None:
    with ServiceClient(service) as dead, ServiceClient(service) as alive:
        with contextlib.suppress(ConnectionClosed):  # a service may close on who asks without listening
            for _ in range(300):
                dead.send(protocol.ListRuns(id=dead.session.next_id()))
                dead.session.pending.clear()
        begun = time.monotonic()
        run = str(alive.do(protocol.StartRun, case=case)["run"])
        alive.do(protocol.Subscribe, run=run, credit=8)
        alive.frame(run, LAST)
        assert time.monotonic() - begun < 20.0
