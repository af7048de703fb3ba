"""kill -9 of a worker, of the service, and of both, at random moments; what clients were told is looked for.

Each round a client starts a run (or goes on with one that a kill interrupted), edits it and watches its
frames, until the kill. After a service is dead another one begins on the same folder. Counted: acknowledged
edits that are not in the working list, received frames that are not in the store with the same bytes, and, of
the runs that came to their end, frames that differ from those of a run that nothing disturbed.
"""

from __future__ import annotations

import itertools
import os
import random
import signal
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import psutil
from websockets.exceptions import ConnectionClosed

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from protocol import EditLine, EditType, Operation

COUNT = 100
SMOKE_COUNT = 5
CASE = "jacksboro"
DURATION_FRAMES = 40
LONGEST_WAIT_S = 2.5
LONGEST_RUN_S = 600.0
_numbers = itertools.count(1)
OPTIONS = {"checkpoint_interval_s": 0.1, "restart_attempts": 1000}


@dataclass
class Tally:
    """What clients were told, and what was not kept."""

    kills: dict[str, int] = field(default_factory=lambda: {"worker": 0, "service": 0, "both": 0})
    acknowledged_edits: int = 0
    received_frames: int = 0
    finished_runs: int = 0
    lost_edits: int = 0
    lost_frames: int = 0
    different_frames: int = 0


@dataclass
class Watched:
    """One run as its client saw it."""

    run: str
    edits: list[str] = field(default_factory=list)
    frames: dict[int, bytes] = field(default_factory=dict)


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Counts over so many kills; every loss is a fault."""
    with tempfile.TemporaryDirectory(prefix="fev-kills-") as folder:
        tally = kill_again_and_again(Path(folder), SMOKE_COUNT if smoke else COUNT)
    for victim, count in tally.kills.items():
        yield {"figure": f"kills_of_{victim}", "value": count, "unit": "kills"}
    for name in (
        "acknowledged_edits",
        "received_frames",
        "finished_runs",
        "lost_edits",
        "lost_frames",
        "different_frames",
    ):
        yield {"figure": name, "value": getattr(tally, name), "unit": "1"}


def kill_again_and_again(
    data_dir: Path, count: int, case: str = CASE, seed: int = 1, **options: object
) -> Tally:
    """Kill so many times and count what was lost.

    Args:
        data_dir: folder of the store, new.
        count: kills.
        case: name or path of the case.
        seed: of the moments and victims.
        options: further fields of `ServiceSettings`.
    """
    chance, tally = random.Random(seed), Tally()
    settings = {**OPTIONS, **options}
    truth: dict[int, bytes] = {}
    watched: Watched | None = None
    left = count
    while left or watched is not None:
        with ServiceProcess(data_dir, **settings) as service:
            while service.process.poll() is None and (left or watched is not None):
                if not truth:
                    truth = _undisturbed(service, case)
                victim = chance.choice(("worker", "service", "both")) if left else ""
                try:
                    with ServiceClient(service) as client:
                        watched = watched or _start(client, case)
                        _check(client, watched, tally)
                        ended = _live(client, watched, chance, tally, victim, service.process.pid)
                except (ConnectionClosed, TimeoutError, OSError):
                    ended = False
                if victim and not ended:
                    left -= 1
                    tally.kills[victim] += 1
                if ended:
                    tally.finished_runs += 1
                    with ServiceClient(service) as client:
                        _check(client, watched, tally)
                        stored = stored_frames(client, watched.run)
                    pairs = [(truth[k], stored.get(k)) for k in truth]
                    tally.different_frames += sum(ours != theirs for ours, theirs in pairs)
                    watched = None
                if victim in ("service", "both") and not ended:
                    service.process.wait(10.0)
                    break
    return tally


def _start(client: ServiceClient, case: str) -> Watched:
    info = next(each for each in client.ask(protocol.ListCases).cases if case.endswith(each.name))
    duration = DURATION_FRAMES * info.output_interval
    return Watched(str(client.do(protocol.StartRun, case=info.name, duration=duration)["run"]))


def _undisturbed(service: ServiceProcess, case: str) -> dict[int, bytes]:
    with ServiceClient(service) as client:
        run = _start(client, case).run
        client.do(protocol.Subscribe, run=run, credit=8)
        client.first(protocol.Frame, lambda frame: frame.index == DURATION_FRAMES, timeout_s=LONGEST_RUN_S)
        return stored_frames(client, run)


def stored_frames(client: ServiceClient, run: str) -> dict[int, bytes]:
    """Frames from the store without what names the run, as the bytes that count."""
    frames: dict[int, bytes] = {}
    count = next(info for info in client.ask(protocol.ListRuns).runs if info.run == run).frame_count
    if not count:
        return frames
    client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=8)
    while len(frames) < count:
        frame = client.first(protocol.Frame, lambda frame: frame.run == run)
        frames[frame.index] = _content(frame)
    client.do(protocol.Unsubscribe)
    return frames


def _content(frame: protocol.Frame) -> bytes:
    return protocol.pack(protocol.Frame(**{**_fields(frame), "run": "r"}))


def _fields(frame: protocol.Frame) -> dict[str, object]:
    return {name: getattr(frame, name) for name in frame.__struct_fields__}


def _check(client: ServiceClient, watched: Watched, tally: Tally) -> None:
    """What was acknowledged before must be there."""
    client.do(protocol.Subscribe, run=watched.run, mode="live")
    edits = client.first(protocol.EditsChanged, lambda event: event.run == watched.run)
    kept = {edit.id for edit in edits.edits}
    tally.lost_edits += sum(name not in kept for name in watched.edits)
    stored = stored_frames(client, watched.run)
    tally.lost_frames += sum(stored.get(index) != frame for index, frame in watched.frames.items())


def _live(
    client: ServiceClient,
    watched: Watched,
    chance: random.Random,
    tally: Tally,
    victim: str,
    service: int,
) -> bool:
    """Watch and edit a run until the kill, or to its end where there is no victim; gives whether it ended."""
    moment = time.monotonic() + chance.uniform(0.0, LONGEST_WAIT_S) if victim else float("inf")
    info = next(each for each in client.ask(protocol.ListRuns).runs if each.run == watched.run)
    if info.status in ("paused", "failed"):
        client.do(protocol.ResumeRun, run=watched.run)
    client.do(protocol.Subscribe, run=watched.run, from_index=info.frame_count, credit=8)
    while time.monotonic() < moment:
        info = next(each for each in client.ask(protocol.ListRuns).runs if each.run == watched.run)
        if info.status == "finished":
            return True
        try:
            frame = client.first(protocol.Frame, timeout_s=0.2)
            watched.frames[frame.index] = _content(frame)
            tally.received_frames += 1
        except TimeoutError:
            pass
        if len(watched.edits) < 50 and chance.random() < 0.3:
            name = f"e{next(_numbers)}"
            client.do(protocol.AppendEdit, run=watched.run, edit=_edit(name, info))
            watched.edits.append(name)
            tally.acknowledged_edits += 1
    _kill(service, victim)
    return False


def _edit(name: str, info: protocol.RunInfo) -> EditLine:
    grid = info.grid.geometry
    ends = (grid.center(5, 5), grid.center(5, grid.ncols - 6))
    return EditLine(
        id=name,
        vertices=ends,
        width=2.0 * grid.dx,
        operation=Operation.raise_,
        type=EditType.modulate,
        magnitude=1.0,
    )


def _kill(service: int, victim: str) -> None:
    workers = psutil.Process(service).children()
    busy = max(workers, key=lambda child: sum(child.cpu_times()[:2]), default=None)
    if victim in ("worker", "both") and busy is not None:
        os.kill(busy.pid, signal.SIGKILL)
    if victim in ("service", "both"):
        os.kill(service, signal.SIGKILL)
