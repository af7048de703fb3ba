"""Begin, end, and sudden death of whole services."""

import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import psutil
import pytest
from websockets.client import ClientProtocol
from websockets.protocol import State
from websockets.uri import parse_uri

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from protocol import BlockLayout
from tests.end_to_end.dam_break import CELLS, levee
from tests.end_to_end.patience import patient

LAST = 20
LAYOUT = BlockLayout(CELLS, CELLS)


def frames(client: ServiceClient, run: str) -> dict[int, np.ndarray]:
    client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=8)
    while not all((run, index) in client.decoded for index in range(LAST + 1)):
        client.first(protocol.Frame)
    return {index: client.decoded[run, index].q for index in range(LAST + 1)}


def wait_for(client: ServiceClient, run: str, status: str) -> protocol.RunInfo:
    while True:
        info = next(info for info in client.ask(protocol.ListRuns).runs if info.run == run)
        if info.status == status:
            return info
        client.first(protocol.RunChanged)


def test_a_service_killed_in_the_middle_of_a_run_loses_nothing_and_goes_on_exactly(
    tmp_path: Path, case: str
) -> None:
    options = {"cases": [case], "threads": 2, "checkpoint_interval_s": 0.02}
    with ServiceProcess(tmp_path, **options) as service, ServiceClient(service, layout=LAYOUT) as client:
        whole = str(client.do(protocol.StartRun, case=case)["run"])
        client.do(protocol.AppendEdit, run=whole, edit=levee("dike"))
        client.do(protocol.Subscribe, run=whole, credit=8)
        client.frame(whole, LAST)
        truth = frames(client, whole)
        run = str(client.do(protocol.StartRun, case=case)["run"])
        client.do(protocol.AppendEdit, run=run, edit=levee("acknowledged"))
        client.do(protocol.Subscribe, run=run, credit=8)
        seen = client.first(protocol.Frame, lambda frame: frame.run == run and frame.index >= 6).index
        service.process.kill()
        service.process.wait()
    with ServiceProcess(tmp_path, **options) as service, ServiceClient(service, layout=LAYOUT) as client:
        infos = {info.run: info for info in client.ask(protocol.ListRuns).runs}
        assert infos[whole].status == "finished"
        assert infos[whole].frame_count == LAST + 1
        assert infos[run].status in ("paused", "finished")
        assert infos[run].frame_count > seen
        client.do(protocol.Subscribe, run=run)
        edits = client.first(protocol.EditsChanged)
        assert [edit.id for edit in edits.edits] == ["acknowledged"]
        if infos[run].status == "paused":
            assert "last checkpoint" in infos[run].message
            client.do(protocol.ResumeRun, run=run)
            wait_for(client, run, "finished")
        resumed = frames(client, run)
        for index, q in truth.items():
            np.testing.assert_array_equal(resumed[index], q)


def test_a_service_that_is_asked_to_end_pauses_its_run_and_goes_on_later(tmp_path: Path, case: str) -> None:
    with ServiceProcess(tmp_path, cases=[case]) as service, ServiceClient(service) as client:
        run = str(client.do(protocol.StartRun, case=case, duration=1000.0)["run"])
        client.do(protocol.Subscribe, run=run, credit=8)
        client.frame(run, 3)
        service.process.send_signal(signal.SIGTERM)
        assert service.process.wait(patient(5.0)) == 0
    with ServiceProcess(tmp_path, cases=[case]) as service, ServiceClient(service) as client:
        info = next(info for info in client.ask(protocol.ListRuns).runs if info.run == run)
        assert info.status == "paused"
        client.do(protocol.ResumeRun, run=run)
        client.do(protocol.Subscribe, run=run, from_index=info.frame_count, credit=8)
        client.frame(run, info.frame_count + 3)


@pytest.mark.parametrize("told_by", ["stdin", "SIGTERM"])
def test_a_service_ends_within_five_seconds_although_a_client_does_not_read(
    tmp_path: Path, case: str, told_by: str
) -> None:
    with ServiceProcess(tmp_path, cases=[case]) as service:
        with ServiceClient(service) as client:
            run = str(client.do(protocol.StartRun, case=case)["run"])
        with _stalled_client(service) as stalled:
            commands = [protocol.GetTerrain(id=number, run=run) for number in range(1, 601)]
            stalled(map(protocol.pack, commands))
            time.sleep(1.0)
            begun = time.monotonic()
            if told_by == "SIGTERM":
                service.process.terminate()
                service.process.wait(60.0)
            else:
                service.stop(60.0)
            assert time.monotonic() - begun < patient(5.0)
        assert service.process.returncode == 0


@contextmanager
def _stalled_client(service: ServiceProcess) -> Iterator[Callable[[Iterable[bytes]], None]]:
    """A client that says hello and then never reads; gives the function that sends for it."""
    uri = parse_uri(service.url)
    peer = ClientProtocol(uri, subprotocols=[protocol.PROTOCOL_VERSION])
    with socket.socket() as raw:
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        raw.connect((uri.host, uri.port))
        peer.send_request(peer.connect())
        raw.sendall(b"".join(peer.data_to_send()))
        while peer.state is not State.OPEN:
            peer.receive_data(raw.recv(65536))

        def send(messages: Iterable[bytes]) -> None:
            for message in messages:
                peer.send_binary(message)
            raw.sendall(b"".join(peer.data_to_send()))

        send([protocol.pack(protocol.Hello(token=service.token))])
        yield send


def _serve_again(data_dir: Path, port: int) -> subprocess.CompletedProcess[str]:
    code = (
        "import sys; from pathlib import Path; from solver_service.web import ServiceSettings, serve\n"
        "from solver_service.errors import ServiceError\n"
        "try: serve(ServiceSettings(data_dir=Path(sys.argv[1]), port=int(sys.argv[2])))\n"
        "except ServiceError as error: sys.exit(str(error))"
    )
    command = [sys.executable, "-c", code, str(data_dir), str(port)]
    return subprocess.run(command, capture_output=True, text=True, timeout=30, check=False)


def test_a_second_service_on_the_same_data_or_port_is_refused_in_one_sentence(
    tmp_path: Path, case: str
) -> None:
    with ServiceProcess(tmp_path / "one", cases=[case]) as service:
        same_data = _serve_again(tmp_path / "one", 0)
        assert same_data.returncode == 1
        assert f"in use by another service (process {service.process.pid})" in same_data.stderr
        assert same_data.stderr.count("\n") == 1
        same_port = _serve_again(tmp_path / "two", int(service.http.rpartition(":")[2]))
        assert same_port.returncode == 1
        assert "Address already in use" in same_port.stderr
        assert same_port.stderr.count("\n") == 1


def test_no_process_outlives_a_service_that_was_killed(tmp_path: Path, case: str) -> None:
    with ServiceProcess(tmp_path, cases=[case]) as service, ServiceClient(service) as client:
        client.do(protocol.StartRun, case=case)
        children = psutil.Process(service.process.pid).children(recursive=True)
        assert children
        service.process.kill()
        service.process.wait()
        _, alive = psutil.wait_procs(children, timeout=60.0)
        assert not alive, "a worker lives on without its service"
