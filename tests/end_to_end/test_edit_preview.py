"""What the viewer shows before Recalculate is, bit for bit, the bed that the service's solver computes on."""

import itertools
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from bench.service_process import ServiceProcess
from solver_service.store import CheckpointStore, DataFolder, RunDatabase
from viewer.app.viewer_app import ViewerApp
from viewer.commands import (
    AddVertex,
    BeginEdit,
    ChangeEdit,
    ChangeEditSettings,
    Command,
    DeleteEdit,
    FinishEdit,
    LoadEdits,
    MoveEdit,
    MoveVertex,
    Pause,
    Recalculate,
    Redo,
    SaveEdits,
    StartRun,
    Undo,
)
from viewer.net import ConnectionThread, FrameLoader

SIDE = 960.0
ROUNDS = 3
TIMEOUT_S = 60.0


class Desk:
    """A viewer without a picture on a real service."""

    def __init__(self, service: ServiceProcess, case: str) -> None:
        connection = ConnectionThread(service.url, service.token)
        self.app = ViewerApp(connection, FrameLoader(), StartRun(case, duration=40.0))
        connection.start()
        self.until(lambda: self.app.shown is not None and len(self.app.shown.timeline) > 4)

    def until(self, condition: Callable[[], bool]) -> None:
        end = time.monotonic() + TIMEOUT_S
        while not condition():
            assert time.monotonic() < end, f"waited in vain; the viewer says {self.app.message!r}"
            if self.app.advance(time.monotonic()) and self.app.frame_inputs() is not None:
                self.app.note_painted((64, 36))
            time.sleep(0.005)

    def do(self, *commands: Command) -> None:
        for command in commands:
            self.app.carry_out(command)
        self.until(lambda: not self.app.is_busy)


def random_edit(rng: np.random.Generator) -> list[Command]:
    kind = str(rng.choice(["line", "area"]))
    settings = ChangeEditSettings(
        width=float(rng.uniform(1.0, 90.0)),
        magnitude=float(rng.uniform(0.1, 20.0)),
        operation=str(rng.choice(["raise", "lower"])),
        type=str(rng.choice(["modulate", "replace"])),
        level=float(rng.uniform(0.0, 60.0)),
        at_level=bool(rng.integers(2)),
    )
    points = [AddVertex(*map(float, rng.uniform(20.0, SIDE - 20.0, 2))) for _ in range(rng.integers(3, 7))]
    return [settings, BeginEdit(kind), *points, FinishEdit()]


def random_change(rng: np.random.Generator, names: list[str]) -> Command:
    name = str(rng.choice(names))
    x, y = map(float, rng.uniform(0.0, SIDE, 2))
    changes: list[Command] = [
        MoveEdit(x - 0.5 * SIDE, y - 0.5 * SIDE, name),
        MoveVertex(1, x, y, name),
        ChangeEdit(type="replace", at_level=False, magnitude=x / 50.0 + 0.1, edit=name),
        ChangeEdit(operation="lower", edit=name),
        DeleteEdit(name),
    ]
    return changes[rng.integers(len(changes))]


@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (2, 3, 4))])
def test_the_solver_computes_on_the_ground_that_was_shown(tmp_path: Path, case: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    with ServiceProcess(tmp_path / "data", cases=[case], threads=2) as service:
        desk = Desk(service, case)
        app = desk.app
        app.carry_out(Pause())
        shown_beds, runs = [], []
        for number in range(ROUNDS):
            for _ in range(3):
                desk.do(*random_edit(rng))
            for _ in range(3):
                assert app.shown is not None
                names = [edit.id for edit in app.shown.document.edits]
                desk.do(random_change(rng, names))
            desk.do(Undo())
            desk.do(Undo())
            desk.do(Redo())
            path = tmp_path / f"{number}.geojson"
            desk.do(SaveEdits(str(path)))
            desk.do(LoadEdits(str(path)))
            app.advance(time.monotonic())
            assert app.shown is not None
            shown_beds.append(app.shown.document.preview().z_b.copy())
            before = app.shown.run
            app.carry_out(Recalculate())
            desk.until(lambda before=before: app.shown is not None and app.shown.run != before)
            desk.until(lambda: not app.is_busy)
            assert app.shown is not None
            runs.append(app.shown.run)
        app.close()
    database = RunDatabase(DataFolder(tmp_path / "data").database)
    store = CheckpointStore(DataFolder(tmp_path / "data"), database)
    try:
        for run, bed in zip(runs, shown_beds, strict=True):
            for record in database.checkpoints(run):
                computed = store.read(record).arrays["z_b"]
                assert computed.dtype == bed.dtype
                assert np.array_equal(computed.view(np.uint32), bed.view(np.uint32))
        assert all(database.checkpoints(run) for run in runs)
    finally:
        database.close()
    assert all((a != b).any() for a, b in itertools.pairwise(shown_beds))
