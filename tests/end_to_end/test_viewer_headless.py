"""The headless viewer and a real service as two processes: stream, edit, recalculate, reconnect, pictures."""

import json
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.end_to_end.dam_break import CELLS, OUTPUT_INTERVAL
from viewer.app.headless import HeadlessSession
from viewer.app.local_service import LocalService
from viewer.app.viewer_app import ViewerApp
from viewer.commands import (
    AddVertex,
    BeginEdit,
    ChangeEditSettings,
    FinishEdit,
    Pause,
    Recalculate,
    Seek,
    StartRun,
    Undo,
)
from viewer.net import BackOff, ConnectionThread, FrameLoader

ROOT = Path(__file__).resolve().parents[2]
CHANGED_LEVEL = 24


@dataclass
class Flight:
    app: ViewerApp
    session: HeadlessSession

    @property
    def run(self) -> str:
        assert self.app.shown is not None
        return self.app.shown.run

    def picture_at(self, time_s: float, name: str) -> np.ndarray:
        self.app.carry_out(Pause())
        self.app.carry_out(Seek(time_s))
        return self.session.picture(name)

    def water_at(self, time_s: float) -> np.ndarray:
        self.picture_at(time_s, "water.png")
        assert self.app.feed.pair is not None
        return self.app.feed.pair.first.h.copy()

    def draw_levee(self) -> None:
        for command in (
            ChangeEditSettings(width=30.0, magnitude=25.0),
            BeginEdit(),
            AddVertex(50.0, 400.0),
            AddVertex(910.0, 400.0),
            FinishEdit(),
        ):
            self.app.carry_out(command)
        self.session.pump(lambda: not self.app.is_busy, "the edit", 20.0)

    def recalculate(self) -> str:
        parent = self.run
        self.app.carry_out(Recalculate())
        self.session.pump(lambda: self.run != parent and not self.app.is_busy, "the branch", 60.0, 0.0)
        return self.run


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory, case: str) -> Iterator[LocalService]:
    with LocalService(tmp_path_factory.mktemp("store"), ["--case", case, "--threads", "2"]) as made:
        yield made


@pytest.fixture
def flight(service: LocalService, case: str, tmp_path: Path) -> Iterator[Flight]:
    connection = ConnectionThread(service.url, service.token, back_off=BackOff(first_s=0.1, longest_s=0.2))
    app = ViewerApp(connection, FrameLoader(), StartRun(case))
    connection.start()
    session = HeadlessSession(app, tmp_path, (640, 360))
    session.wait_computed(100.0, 120.0)
    yield Flight(app, session)
    session.close()
    app.close()


def changed_share(before: np.ndarray, after: np.ndarray) -> float:
    return float(np.mean(np.abs(before.astype(int) - after.astype(int)).max(axis=2) > CHANGED_LEVEL))


def test_the_water_that_is_shown_flows_down_the_valley(flight: Flight) -> None:
    early, late = flight.water_at(0.0), flight.water_at(60.0)

    assert early.shape == (CELLS, CELLS)
    assert np.flatnonzero(early.max(axis=1)).max() < np.flatnonzero(late.max(axis=1)).max()
    assert 0.5 * early.sum() < late.sum() <= 1.001 * early.sum()  # some leaves by the open edge


def test_a_levee_changes_the_flood_after_it_and_nothing_before(flight: Flight) -> None:
    before, without = flight.picture_at(90.0, "before.png"), flight.water_at(90.0)
    past = flight.water_at(10.0)
    drawn_at = 3 * OUTPUT_INTERVAL
    flight.picture_at(drawn_at, "drawn.png")
    flight.draw_levee()
    flight.recalculate()
    assert flight.app.clock.time == drawn_at
    latency = flight.app.fresh_status().recalculate_latency_s
    assert latency is not None
    assert latency < 10.0
    flight.session.wait_computed(100.0, 120.0)
    after = flight.picture_at(90.0, "after.png")

    assert changed_share(before, after) > 0.01
    np.testing.assert_array_equal(flight.water_at(10.0), past)
    assert flight.water_at(90.0)[60:].sum() < 0.7 * without[60:].sum()


def test_recalculating_without_an_edit_changes_no_pixel_of_the_flood(flight: Flight) -> None:
    before = flight.water_at(90.0)
    flight.picture_at(20.0, "drawn.png")
    flight.recalculate()
    flight.session.wait_computed(100.0, 120.0)

    np.testing.assert_array_equal(flight.water_at(90.0), before)


def test_undo_and_recalculating_again_gives_the_first_flood_back(flight: Flight) -> None:
    before = flight.water_at(90.0)
    flight.picture_at(20.0, "drawn.png")
    flight.draw_levee()
    flight.recalculate()
    flight.app.carry_out(Undo())
    flight.session.pump(lambda: flight.app.fresh_status().edits == (), "the undo", 20.0)
    flight.recalculate()
    flight.session.wait_computed(100.0, 120.0)

    np.testing.assert_allclose(flight.water_at(90.0), before, atol=0.01)


def test_a_cut_connection_comes_back_and_the_run_goes_on(flight: Flight) -> None:
    connection = flight.app.desk.connection
    flight.picture_at(50.0, "seen.png")
    assert connection._socket is not None
    connection._socket.socket.shutdown(socket.SHUT_RDWR)
    flight.session.pump(lambda: not flight.app.desk.is_open, "the loss", 20.0)
    flight.session.pump(lambda: flight.app.desk.is_open, "the return", 20.0)
    flight.draw_levee()
    flight.recalculate()
    flight.session.wait_computed(80.0, 120.0)

    assert flight.app.fresh_status().is_connected


def test_the_demo_flies_the_whole_tour(case: str, tmp_path: Path) -> None:
    begun = time.monotonic()
    done = subprocess.run(
        [sys.executable, "-m", "viewer", "demo", case, "--headless", str(tmp_path / "out")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=200,
    )
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))

    assert summary["cells"] == CELLS * CELLS
    assert summary["hypothetical"] is True
    assert abs(summary["volume_error_relative"]) < 1e-5
    assert 0.0 < summary["recalculate_latency_s"] <= summary["recalculate_next_frame_s"]
    assert summary["first_picture_s"] < time.monotonic() - begun
    assert len(summary["pictures"]) >= 8
    assert "Recalculate" in done.stdout
    pictures = {name: np.asarray(Image.open(tmp_path / "out" / name)) for name in summary["pictures"]}
    for name, pixels in pictures.items():
        assert len(np.unique(pixels.reshape(-1, 3)[::31], axis=0)) > 100, f"{name} is blank"
    before, after = (pictures[name] for name in summary["pictures"] if name[:2] in ("06", "09"))
    assert changed_share(before, after) == pytest.approx(summary["changed_share"])
    assert summary["changed_share"] > 0.005
    assert changed_share(before, before) == 0.0
    assert (tmp_path / "out" / "contact_sheet.png").stat().st_size > 50_000


def test_a_script_is_followed_to_the_letter(service: LocalService, case: str, tmp_path: Path) -> None:
    token = tmp_path / "token"
    token.write_text(service.token, encoding="utf-8")
    script = tmp_path / "script.toml"
    script.write_text(
        """
[[step]]
until_time = 40.0
command = "Pause"

[[step]]
command = "Seek"
time = 30.0
picture = "thirty.png"

[[step]]
command = "SetOption"
name = "water_colour"
value = "depth"
picture = "classes.png"
""",
        encoding="utf-8",
    )
    out = tmp_path / "out"
    command = [sys.executable, "-m", "viewer", service.url, "--token-file", str(token), "--case", case]
    done = subprocess.run(
        [*command, "--headless", str(out), "--script", str(script)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=200,
    )

    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in out.iterdir()) == ["classes.png", "summary.json", "thirty.png"]
    assert json.loads((out / "summary.json").read_text(encoding="utf-8"))["pictures"] == [
        "thirty.png",
        "classes.png",
    ]


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ([], "ws://HOST:PORT"),
        (["http://127.0.0.1:1", "--headless", "out"], "must begin with ws://"),
        (["ws://127.0.0.1:1", "--token-file", "missing"], "token file"),
        (["--local", "jacksboro", "--script", "x.toml"], "--script needs --headless"),
        (["--local", "nowhere-at-all", "--headless", "out"], "nowhere-at-all"),
        (["--local", "jacksboro", "--headless", "out", "--script", "missing.toml"], "missing.toml"),
    ],
)
def test_a_wrong_call_ends_with_one_sentence_and_leaves_nothing(
    arguments: list[str], complaint: str, tmp_path: Path
) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "viewer", *arguments],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=120,
    )

    assert done.returncode != 0
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("fev-viewer: ")
    assert complaint in lines[0]
    assert not list(tmp_path.iterdir())


def test_a_wrong_token_is_told_and_not_tried_again(service: LocalService, tmp_path: Path) -> None:
    token = tmp_path / "token"
    token.write_text("x" * 40, encoding="utf-8")
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "viewer",
            service.url,
            "--token-file",
            str(token),
            "--headless",
            str(tmp_path / "o"),
        ],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
    )

    assert done.returncode == 2
    assert "token" in done.stderr
