"""A disk of its own for the data folder: full, then larger, then read-only. Needs leave to mount a tmpfs."""

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import protocol
from bench.kills import stored_frames
from bench.service_process import ServiceClient, ServiceProcess

DURATION = 1500.0
LAST = 300


def mount(*arguments: str) -> bool:
    """Whether it could be mounted."""
    try:
        done = subprocess.run(["mount", *arguments], capture_output=True, check=False, timeout=30)
    except FileNotFoundError:
        return False
    return done.returncode == 0


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Path]:
    """A folder that is a disk of 2 MB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    if not mount("-t", "tmpfs", "-o", "size=2m", "tmpfs", str(folder)):
        pytest.skip("no tmpfs can be mounted here (this needs root on Linux)")
    yield folder
    subprocess.run(["umount", "--lazy", str(folder)], check=True, timeout=30)


def told(client: ServiceClient, run: str, words: str) -> protocol.Notice:
    return client.first(protocol.Notice, lambda notice: notice.run == run and words in notice.text)


def resumed_to_the_end(client: ServiceClient, run: str) -> dict[int, bytes]:
    client.first(protocol.RunChanged, lambda event: event.run.run == run and event.run.status == "finished")
    return stored_frames(client, run)


@pytest.mark.slow
def test_a_run_whose_disk_is_full_or_read_only_waits_in_words_and_goes_on_exactly(
    disk: Path, tmp_path: Path, case: str
) -> None:
    with (
        ServiceProcess(tmp_path / "roomy", cases=[case], threads=2) as service,
        ServiceClient(service) as client,
    ):
        truth = str(client.do(protocol.StartRun, case=case, duration=DURATION)["run"])
        expected = resumed_to_the_end(client, truth)
    assert len(expected) == LAST + 1
    options = {"cases": [case], "threads": 2, "reserve_bytes": 0, "checkpoint_interval_s": 3600.0}
    with ServiceProcess(disk, **options) as service, ServiceClient(service) as client:
        run = str(client.do(protocol.StartRun, case=case, duration=DURATION)["run"])
        client.do(protocol.Subscribe, run=run, credit=1)
        assert re.search("No space left|full", told(client, run, "paused: ").text)
        assert mount("-o", "remount,size=64m", str(disk))
        assert resumed_to_the_end(client, run) == expected, "it goes on by itself to the same bytes"

    assert mount("-o", "remount,ro", str(disk))
    command = [sys.executable, "-m", "solver_service", "serve", "--port", "0", "--data-dir", str(disk)]
    refused = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert refused.returncode != 0
    assert "Traceback" not in refused.stderr
    assert re.search("[Rr]ead-only", refused.stderr)
    assert mount("-o", "remount,rw", str(disk))
    with ServiceProcess(disk, **options) as service, ServiceClient(service) as client:
        assert stored_frames(client, run) == expected
