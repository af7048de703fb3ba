"""A levee that breaches, on the picture: whole before, a gap after, whole again when time goes back."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from viewer.app.headless import HeadlessSession
from viewer.app.local_service import LocalService
from viewer.app.viewer_app import ViewerApp
from viewer.commands import FlyTo, Pause, ProbeAt, Seek, SetOption, StartRun
from viewer.net import ConnectionThread, FrameLoader

EXAMPLE = Path(__file__).parents[2] / "examples" / "levee_breach"
CASE = "levee_breach"
GAP = (195.0, 200.0)
"""The middle of the breach [m]."""
WHOLE, OPEN = 240.0, 600.0
"""Before the breach begins at 300 s, and when it has ended [s]."""


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[HeadlessSession]:
    with LocalService(
        tmp_path_factory.mktemp("store"), ["--case", str(EXAMPLE), "--threads", "1"]
    ) as service:
        app = ViewerApp(ConnectionThread(service.url, service.token), FrameLoader(), StartRun(CASE))
        app.desk.connection.start()
        made = HeadlessSession(app, tmp_path_factory.mktemp("pictures"), (480, 300))
        made.wait_computed(1200.0, 120.0)
        app.carry_out(Pause())
        app.carry_out(FlyTo(*GAP, distance=160.0, azimuth=90.0, elevation=50.0, seconds=0.0))
        yield made
        made.close()
        app.close()


def at(session: HeadlessSession, time: float) -> tuple[np.ndarray, float, float | None]:
    """The picture, the ground and the water level in the gap [m]."""
    session.app.carry_out(Seek(time))
    session.app.carry_out(ProbeAt(*GAP))
    picture = session.picture(f"{time:.0f}.png")
    probe = session.app.fresh_status().probe
    assert probe is not None
    return picture, probe.ground, probe.level


def changed_near_the_gap(first: np.ndarray, second: np.ndarray) -> float:
    height, width = first.shape[:2]
    middle = slice(height // 3, 2 * height // 3), slice(width // 3, 2 * width // 3)
    return float((np.abs(first.astype(int) - second)[middle].max(axis=2) > 24).mean())


def test_the_gap_is_seen_at_its_time_and_the_levee_is_whole_before_it(session: HeadlessSession) -> None:
    whole, crest, _ = at(session, WHOLE)
    gap, floor, level = at(session, OPEN)
    again, crest_again, _ = at(session, WHOLE)

    assert crest == pytest.approx(5.0, abs=0.05)
    assert floor < crest - 1.5
    assert level is not None
    assert floor < level < crest
    assert crest_again == crest
    assert np.array_equal(again, whole)
    assert changed_near_the_gap(whole, gap) > 0.2
    assert changed_near_the_gap(whole, again) == 0.0


def test_ground_and_level_on_the_picture_are_those_of_the_solver(session: HeadlessSession) -> None:
    at(session, OPEN)
    shown = session.app.shown
    pair = session.app.feed.pair
    assert shown is not None
    assert pair is not None
    assert pair.first.z_b is not None
    lowered = np.flatnonzero((pair.first.z_b != shown.document.base).ravel())

    assert lowered.size > 0
    assert np.array_equal(shown.heightfield.z_b, pair.first.z_b)
    assert not np.array_equal(shown.heightfield.z_b, shown.document.base)


def test_between_two_frames_the_gap_is_deeper_than_before_and_shallower_than_after(
    session: HeadlessSession,
) -> None:
    grounds = [at(session, time)[1] for time in (300.0, 315.0, 330.0, 345.0, 360.0)]

    assert grounds == sorted(grounds, reverse=True)
    assert grounds[0] > grounds[2] > grounds[4]


def test_channels_of_the_service_colour_the_water_and_answer_the_probe(session: HeadlessSession) -> None:
    at(session, OPEN)
    app = session.app
    look = app.water.look
    app.carry_out(SetOption("water_colour", "speed"))
    session.pump(lambda: look.colouring is not None and look.note == "", "velocity", 20.0)
    session.pump(
        lambda: (now := app.fresh_status().probe) is not None and now.speed is not None, "speed", 20.0
    )
    probe, colouring, pair = app.fresh_status().probe, look.colouring, app.feed.pair
    assert probe is not None
    assert colouring is not None
    assert pair is not None
    speed = colouring.fields[0].values
    row, col = int(GAP[1] // 10.0), int(GAP[0] // 10.0)

    assert probe.speed == pytest.approx(float(speed[row, col]), abs=1e-6)
    assert probe.speed > 0.2
    assert probe.bearing == pytest.approx(90.0, abs=60.0)  # from the river into the valley
    assert not speed[pair.first.h == 0.0].any()

    at(session, 1200.0)
    app.carry_out(SetOption("water_colour", "max_depth"))
    session.pump(lambda: look.colouring is not None and look.note == "", "maxima", 20.0)
    pair = app.feed.pair
    assert pair is not None
    assert look.colouring is not None
    deepest = look.colouring.fields[0].values
    wet = pair.first.h > 0.0
    assert (deepest[wet] >= pair.first.h[wet] - 0.01).all()
    assert (deepest > pair.first.h + 0.05).any()
    app.carry_out(SetOption("water_colour", "natural"))
