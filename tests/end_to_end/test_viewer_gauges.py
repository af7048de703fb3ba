"""Gauges and sections of a real case in the viewer: marks on the picture, series at full rate."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from viewer.app.headless import HeadlessSession
from viewer.app.local_service import LocalService
from viewer.app.viewer_app import ViewerApp
from viewer.commands import (
    CommandError,
    CompareWith,
    FlyTo,
    Pause,
    ProbeAt,
    Recalculate,
    Seek,
    SetOption,
    ShowSeries,
    StartRun,
)
from viewer.net import ConnectionThread, FrameLoader
from viewer.view_status import PlaceRow, ViewStatus

EXAMPLE = Path(__file__).parents[2] / "examples" / "levee_breach"
DURATION, FRAME, RATE = 480.0, 60.0, 10.0
TOWN = (305.0, 205.0)
SIZE = (480, 300)


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[HeadlessSession]:
    with LocalService(
        tmp_path_factory.mktemp("store"), ["--case", str(EXAMPLE), "--threads", "1"]
    ) as service:
        start = StartRun("levee_breach", duration=DURATION)
        app = ViewerApp(ConnectionThread(service.url, service.token), FrameLoader(), start)
        app.desk.connection.start()
        made = HeadlessSession(app, tmp_path_factory.mktemp("pictures"), SIZE)
        made.pump(lambda: app.shown is not None and len(app.shown.timeline) > 1, "the first frames", 60.0)
        app.carry_out(ShowSeries("town"))  # fetched while the run computes, if it is not done yet
        made.wait_computed(DURATION, 120.0)
        app.carry_out(Pause())
        app.carry_out(FlyTo(*TOWN, distance=400.0, azimuth=0.0, elevation=60.0, seconds=0.0))
        yield made
        made.close()
        app.close()


def shown(session: HeadlessSession, last: float = DURATION) -> ViewStatus:
    """The status once the chosen series has come up to a time."""

    def is_whole() -> bool:
        status = session.app.fresh_status()
        record = status.depth_record if status.discharge_record[0] == () else status.discharge_record
        return bool(record[0]) and record[0][-1] >= last

    session.pump(is_whole, "the series", 20.0)
    return session.app.fresh_status()


def test_a_gauge_shows_its_series_at_full_rate(session: HeadlessSession) -> None:
    session.app.carry_out(ShowSeries("river"))
    session.app.carry_out(Seek(DURATION))
    session.picture("end.png")
    status = shown(session)
    times, depths = status.depth_record

    assert status.places == tuple(
        PlaceRow(*row) for row in (("town", "gauge"), ("river", "gauge"), ("behind the levee", "section"))
    )
    assert status.series_of == PlaceRow("river", "gauge")
    assert {round(after - before, 6) for before, after in pairwise(times)} == {RATE}
    assert len(status.speed_record[0]) == len(times)
    assert status.probe is not None
    assert depths[-1] == pytest.approx(0.0 if status.probe.depth is None else status.probe.depth, abs=0.01)
    assert max(depths) > 1.0
    assert max(status.speed_record[1]) > 0.1


def test_a_section_shows_what_passes_it(session: HeadlessSession) -> None:
    session.app.carry_out(ShowSeries("behind the levee"))
    status = shown(session)
    times, discharge = np.asarray(status.discharge_record)

    assert status.depth_record == ((), ())
    assert abs(discharge[times <= 300.0]).max() < 0.2 * abs(discharge).max()
    assert abs(discharge).max() > 1.0


def test_an_unknown_name_is_refused_and_leaves_what_is_shown(session: HeadlessSession) -> None:
    session.app.carry_out(ShowSeries("river"))
    with pytest.raises(CommandError, match="'nowhere' is no gauge or section; known are 'town', 'river'"):
        session.app.carry_out(ShowSeries("nowhere"))
    with pytest.raises(CommandError, match="known are"):
        session.app.carry_out(ShowSeries("river", "section"))

    assert session.app.fresh_status().series_of == PlaceRow("river", "gauge")


def test_a_click_at_the_mark_chooses_the_gauge_and_one_elsewhere_the_point(session: HeadlessSession) -> None:
    app = session.app
    app.carry_out(ProbeAt(TOWN[0] + 3.0, TOWN[1] + 5.0))
    assert app.fresh_status().series_of == PlaceRow("town", "gauge")
    app.carry_out(ProbeAt(TOWN[0] + 60.0, TOWN[1]))
    away = app.fresh_status()
    assert away.series_of is None
    assert away.probe is not None
    assert away.probe.x == TOWN[0] + 60.0
    app.carry_out(SetOption("show_gauges", False))
    app.carry_out(ProbeAt(*TOWN))
    assert app.fresh_status().series_of is None
    app.carry_out(SetOption("show_gauges", True))


def test_marks_are_on_the_picture_where_the_places_are_and_go_with_their_layer(
    session: HeadlessSession,
) -> None:
    app = session.app
    app.carry_out(ShowSeries(None))
    app.carry_out(Seek(DURATION))
    marked = session.picture("marked.png").astype(int)
    app.carry_out(SetOption("show_gauges", False))
    bare = session.picture("bare.png").astype(int)
    app.carry_out(SetOption("show_gauges", True))
    again = session.picture("again.png").astype(int)
    differs = np.abs(marked - bare).max(axis=2) > 24
    middle = differs[SIZE[1] // 2 - 35 : SIZE[1] // 2 + 2, SIZE[0] // 2 - 30 : SIZE[0] // 2 + 30]

    assert middle.mean() > 0.1, "the pin and name of the gauge that is looked at"
    assert 0.002 < differs.mean() < 0.1, "and little else"
    assert not (np.abs(marked - again).max(axis=2) > 24).any()


def test_a_branch_has_the_series_of_its_shared_past_and_is_compared_with_its_parent(
    session: HeadlessSession,
) -> None:
    app = session.app
    app.carry_out(ShowSeries("town"))
    parent, before = app.fresh_status().shown_run, shown(session).depth_record
    app.carry_out(Seek(180.0))
    app.carry_out(Recalculate())
    session.pump(
        lambda: app.fresh_status().shown_run != parent and not app.fresh_status().is_recalculating,
        "the branch",
        30.0,
    )
    session.wait_computed(DURATION, 60.0)
    app.carry_out(CompareWith(parent))
    branch = shown(session)
    session.pump(lambda: app.fresh_status().other_depth_record == before, "the parent's series", 20.0)

    assert branch.series_of == PlaceRow("town", "gauge")
    assert branch.depth_record == before, "nothing was edited"
    app.carry_out(CompareWith(None))
