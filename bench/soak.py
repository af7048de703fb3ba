"""Half an hour of everything: does a service grow, and does anything remain that has no row?

Two people start runs, draw, take back, recalculate, rename, pin and delete; three visitors come, watch, seek,
and go: politely, or cut off in the middle, or after a while of not reading. Memory, open files and threads of
the service, and those of its largest worker, are sampled all the time; `bench.slope` says whether they grow.
In the end every run is deleted, the service stops, and the data folder is looked through.
"""

from __future__ import annotations

import random
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psutil
from websockets.exceptions import ConnectionClosed

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from bench.slope import slope_of
from bench.slosh import write_slosh_case
from protocol import EditLine, EditType, Operation
from solver_service.store import DataFolder, RunDatabase, find_faults

SIDE = 96
LAST = 60
INTERVAL = 5.0
DURATION_S = 1800.0
SMOKE_DURATION_S = 10.0
WARM_UP = 0.25
"""Share of the time that is not looked at: pools fill, kernels load."""
SAMPLES = 600
PEOPLE = 2
VISITORS = 3
MB = 1e6


@dataclass(frozen=True)
class Allowed:
    """Growth over the time looked at that is not yet a leak."""

    memory: float
    files: float
    threads: float


ALLOWED = Allowed(memory=20.0 * MB, files=4.0, threads=2.0)
SMOKE_ALLOWED = Allowed(memory=60.0 * MB, files=20.0, threads=20.0)


class Sampler:
    """Samples of a service and its workers."""

    def __init__(self, pid: int) -> None:
        self.times: list[float] = []
        self.values: dict[str, list[float]] = {}
        self._web = psutil.Process(pid)

    def sample(self) -> None:
        """Take one."""
        workers = [(0.0, 0.0, 0.0)]
        for child in self._web.children():
            with suppress(psutil.Error):  # it ended just now
                workers.append(_sizes(child))
        measured = {"service": _sizes(self._web), "worker": tuple(map(max, *workers))}
        self.times.append(time.monotonic())
        for process, sizes in measured.items():
            for name, value in zip(("memory", "files", "threads"), sizes, strict=True):
                self.values.setdefault(f"{process}_{name}", []).append(value)

    def growth(self, allowed: Allowed) -> Iterator[dict[str, object]]:
        """A figure for each thing, after the warm-up."""
        first = int(WARM_UP * len(self.times))
        for name, values in self.values.items():
            slope = slope_of(self.times[first:], values[first:])
            floor = getattr(allowed, name.rpartition("_")[2])
            scale, unit = (MB, "MB") if name.endswith("memory") else (1.0, "1")
            yield {
                "figure": f"{name}_growth",
                "value": round(slope.growth / scale, 2),
                "unit": unit,
                "least": round(slope.least / scale, 2),
                "most": round(slope.most / scale, 2),
                "floor": floor / scale,
                "grows": slope.exceeds(floor),
                "last": round(values[-1] / scale, 1),
                "samples": len(values) - first,
            }


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """What grew, what remained, and what was done meanwhile."""
    duration = SMOKE_DURATION_S if smoke else DURATION_S
    with tempfile.TemporaryDirectory(prefix="fev-soak-") as folder:
        yield from soak(Path(folder), duration, SMOKE_ALLOWED if smoke else ALLOWED)


def soak(folder: Path, duration: float, allowed: Allowed) -> Iterator[dict[str, object]]:
    """Keep a service busy for so long.

    Args:
        folder: for case and data, empty.
        duration: how long [s].
        allowed: what may grow how much.

    Raises:
        RuntimeError: the service refused what it had to do.
    """
    case = str(write_slosh_case(folder / "slosh", SIDE, SIDE, LAST * INTERVAL, INTERVAL))
    options: dict[str, Any] = {"threads": 1, "ring_bytes": 1 << 23, "checkpoint_interval_s": 1.0}
    done = Counter[str]()
    with ServiceProcess(folder / "data", cases=[case], **options) as service:
        sampler = Sampler(service.process.pid)
        with ThreadPoolExecutor(PEOPLE + VISITORS) as pool:
            busy: list[tuple[Callable[..., None], int]] = [(_person, k) for k in range(PEOPLE)]
            busy += [(_visitor, PEOPLE + k) for k in range(VISITORS)]
            stop = threading.Event()
            waits = [pool.submit(work, service, case, random.Random(k), stop, done) for work, k in busy]
            while not done["recalculations"] and not any(wait.done() for wait in waits):
                time.sleep(0.1)
            ends = time.monotonic() + duration
            while time.monotonic() < ends and not any(wait.done() for wait in waits):
                sampler.sample()
                time.sleep(duration / SAMPLES)
            stop.set()
            for wait in waits:
                wait.result()
        with ServiceClient(service) as client:
            left = len(client.ask(protocol.ListRuns).runs)
    yield from sampler.growth(allowed)
    for name, count in sorted(done.items()):
        yield {"figure": name, "value": count, "unit": "1"}
    yield {"figure": "runs_left", "value": left, "unit": "1", "floor": 0}
    yield {"figure": "files_without_a_row", "value": len(remains(folder / "data")), "unit": "1", "floor": 0}


def remains(data_dir: Path) -> list[str]:
    """What lies in the folder of a service that has ended and has no run."""
    folder = DataFolder(data_dir)
    database = RunDatabase(folder.database)
    try:
        found = [fault.sentence for fault in find_faults(folder, database)]
    finally:
        database.close()
    areas = ("frames", "checkpoints")
    return found + [str(path) for area in areas for path in (data_dir / area).rglob("*") if path.is_file()]


def _sizes(process: psutil.Process) -> tuple[float, ...]:
    with process.oneshot():
        return float(process.memory_info().rss), float(process.num_fds()), float(process.num_threads())


def _person(
    service: ServiceProcess, case: str, chance: random.Random, stop: threading.Event, done: Counter[str]
) -> None:
    """Somebody who makes runs and clears them away, again and again."""
    number = 0
    while not stop.is_set():
        with ServiceClient(service) as client:
            run = str(client.do(protocol.StartRun, case=case)["run"])
            done["runs"] += 1
            client.do(protocol.Subscribe, run=run, credit=4)
            client.frame(run, chance.randrange(1, 6))
            tree = [run]
            for _ in range(chance.randrange(1, 4)):
                number += 1
                client.do(protocol.AppendEdit, run=tree[-1], edit=_levee(f"e{number}", chance))
                done["edits"] += 1
                if chance.random() < 0.3:
                    client.do(protocol.UndoEdit, run=tree[-1])
                    client.do(protocol.RedoEdit, run=tree[-1])
                info = next(info for info in client.ask(protocol.ListRuns).runs if info.run == tree[-1])
                index = chance.randrange(info.branch_index or 0, info.frame_count)
                answer = client.do(
                    protocol.Recalculate,
                    run=tree[-1],
                    index=index,
                    revision=info.revision,
                    keep_parent=chance.random() < 0.3,
                )
                tree.append(str(answer["run"]))
                done["recalculations"] += 1
                client.frame(tree[-1], index)
            client.do(protocol.RenameRun, run=run, label=f"{number} floods")
            client.do(protocol.PinRun, run=run)
            client.do(protocol.UnpinRun, run=run)
            for name in reversed(tree):
                client.ask(protocol.StopRun, run=name)  # refused where it has finished
                _delete(client, name)
                done["deletions"] += 1


def _delete(client: ServiceClient, run: str) -> None:
    """Delete a run, again where the disk is behind.

    Raises:
        RuntimeError: it was refused for another reason.
    """
    while isinstance(answer := client.ask(protocol.DeleteRun, run=run), protocol.Error):
        if "try again" not in answer.message:
            raise RuntimeError(f"delete_run was refused: {answer}")


def _visitor(
    service: ServiceProcess, case: str, chance: random.Random, stop: threading.Event, done: Counter[str]
) -> None:
    """Somebody who looks at what others compute, and goes in one of three ways."""
    while not stop.is_set():
        with suppress(ConnectionClosed), ServiceClient(service) as client:
            done["visits"] += 1
            runs = client.ask(protocol.ListRuns).runs
            if runs:
                run = chance.choice(runs).run
                mode = chance.choice(("live", "replay"))
                client.ask(protocol.Subscribe, run=run, mode=mode, credit=4)  # it may be deleted by now
                for _ in range(chance.randrange(4)):
                    with suppress(TimeoutError):
                        client.first(protocol.Frame, timeout_s=0.2)
                    client.ask(protocol.Seek, run=run, index=chance.randrange(LAST))
            way = chance.choice(("polite", "cut", "silent"))
            if way == "cut":
                client.cut()
                done["cuts"] += 1
            elif way == "silent":
                stop.wait(chance.uniform(0.0, 2.0))


def _levee(name: str, chance: random.Random) -> EditLine:
    y = chance.uniform(100.0, 10.0 * SIDE - 100.0)
    return EditLine(
        id=name,
        vertices=((50.0, y), (10.0 * SIDE - 50.0, y)),
        width=30.0,
        operation=Operation.raise_,
        type=EditType.modulate,
        magnitude=chance.uniform(1.0, 5.0),
    )
