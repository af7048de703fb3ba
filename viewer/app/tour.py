"""The tour of the headless demo: a flood while it is computed, a levee in its way, the changed flood.

The tour does what a user would do, with the same commands: start, watch, go back, draw a line across the
path of the water ahead of the front, recalculate from there, and look at the same place at the same time
again.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viewer.app.contact_sheet import make_contact_sheet, side_by_side
from viewer.app.flood_front import Front, LeveeLine, find_front, place_levee
from viewer.app.headless import HeadlessError, HeadlessSession
from viewer.app.shown_run import ShownRun
from viewer.app.summary import FlightSummary, summarise
from viewer.app.viewer_app import ViewerApp
from viewer.commands import (
    AddVertex,
    BeginEdit,
    ChangeEditSettings,
    CompareWith,
    FinishEdit,
    FlyTo,
    Pause,
    PauseRun,
    Recalculate,
    Seek,
    SetOption,
    TopView,
)
from viewer.view_status import time_text

__all__ = ["TourSettings", "fly_tour"]

Pixels = npt.NDArray[np.uint8]

CHANGED_LEVEL = 24
"""Difference of a colour channel from which a pixel counts as changed, of 255."""
CHANGED_LEAST = 0.002
"""Share of the pixels that must differ after a recalculation."""


@dataclass(frozen=True)
class TourSettings:
    """How long the tour may take.

    Attributes:
        start_timeout_s: wall time for the service to start and bring the first frame [s].
        watch_s: wall time spent watching the flood while it is computed [s].
        watch_least_frames: frames that must be there before the levee is drawn, however long that takes.
        after_s: wall time for the recalculated run to reach the time of comparison [s].
        watch_pictures: pictures taken of the front while it is computed.
    """

    start_timeout_s: float = 240.0
    watch_s: float = 20.0
    watch_least_frames: int = 24
    after_s: float = 180.0
    watch_pictures: int = 4


def fly_tour(session: HeadlessSession, started: float, settings: TourSettings | None = None) -> FlightSummary:
    """Fly the tour and return its figures; the run must have been started.

    Args:
        session: the flight.
        started: wall time at which the viewer began [s, monotonic].
        settings: how long it may take.

    Raises:
        HeadlessError: no frame came, the water reached no new ground, or the picture did not change.
    """
    settings = TourSettings() if settings is None else settings
    app = session.app
    session.pump(
        lambda: app.shown is not None and len(app.shown.timeline) > 0,
        "the first frame",
        settings.start_timeout_s,
        0.0,
    )
    first_run = _shown(app).run
    session.paint()
    _watch(session, settings)
    levee, drawn_at, compared_at, source = _plan(session)
    view = _view_of(app, levee, source)
    app.carry_out(Pause())
    app.carry_out(view)
    app.carry_out(Seek(compared_at))
    before = session.picture(f"06_without_levee_{_stamp(compared_at)}.png")
    app.carry_out(Seek(drawn_at))
    _draw(session, levee)
    session.picture(f"07_levee_drawn_{_stamp(drawn_at)}.png")
    app.carry_out(FinishEdit())
    session.pump(lambda: not app.is_busy, "the edit to be taken", 30.0)
    _recalculate(session)
    session.picture(f"08_recalculated_from_{_stamp(drawn_at)}.png")
    session.wait_computed(compared_at, settings.after_s)
    app.carry_out(Pause())
    app.carry_out(Seek(compared_at))
    after = session.picture(f"09_with_levee_{_stamp(compared_at)}.png")
    app.carry_out(CompareWith(first_run))
    session.pump(lambda: app.comparison.difference is not None, "the difference to the first run", 30.0)
    session.picture(f"10_difference_{_stamp(compared_at)}.png")
    app.carry_out(CompareWith(None))
    _top_view(session)
    session.picture("11_top_view_depth_classes.png")
    app.carry_out(PauseRun())
    names = session.pictures
    side_by_side(
        session.folder / names[-6],
        session.folder / names[-3],
        ("without the levee", "with the levee"),
        session.folder / "12_before_and_after.png",
    )
    session.pictures.append("12_before_and_after.png")
    summary = summarise(app, session, first_run, started)
    summary.changed_share = _changed_share(before, after)
    make_contact_sheet(
        session.folder, session.pictures[:-1], summary.title or "", session.folder / "contact_sheet.png"
    )
    summary.contact_sheet = "contact_sheet.png"
    summary.total_wall_s = round(time.monotonic() - started, 2)
    if summary.changed_share < CHANGED_LEAST:
        raise HeadlessError(
            f"the recalculated flood looks like the old one: {summary.changed_share:.2%} of the pixels differ"
        )
    return summary


def _watch(session: HeadlessSession, settings: TourSettings) -> None:
    """Take pictures of the front while the flood is computed.

    The pictures are spread evenly over the run. Where the solver is too slow for that, each is taken when its
    share of the watching time is over, of the newest frame.
    """
    app = session.app
    session.picture("01_overview.png")
    begun = time.monotonic()
    for number in range(settings.watch_pictures):
        share = (number + 1) / (settings.watch_pictures + 1)
        frames = math.ceil(share * settings.watch_least_frames)
        due = begun + share * settings.watch_s
        wanted = share * _shown(app).info.duration

        def is_due(frames: int = frames, due: float = due, wanted: float = wanted) -> bool:
            shown = _shown(app)
            count = len(shown.timeline)
            has_ended = shown.info.status in ("finished", "stopped", "failed")
            if (has_ended and count >= shown.info.frame_count) or (
                time.monotonic() >= due and count >= frames
            ):
                return True
            return shown.timeline.last_time >= wanted and count >= frames

        session.pump(is_due, f"{frames} computed frames", settings.start_timeout_s)
        app.carry_out(Seek(min(wanted, _shown(app).timeline.last_time)))
        _fly_to_front(session)
        session.picture(f"{number + 2:02d}_front_{_stamp(app.clock.time)}.png")


def _fly_to_front(session: HeadlessSession) -> None:
    app = session.app
    shown = _shown(app)
    index = shown.timeline.index_before(app.clock.time)
    front = _front_at(session, index)
    if front is None:
        return
    earlier = _front_at(session, max(index // 2, 1))
    bearing = 0.0
    if earlier is not None and (front.row, front.col) != (earlier.row, earlier.col):
        bearing = math.degrees(math.atan2(front.col - earlier.col, front.row - earlier.row))
    x, y = shown.grid.center(front.row, front.col)
    app.carry_out(FlyTo(x, y, _distance(shown), (bearing + 150.0) % 360.0, 32.0, 0.0))


def _plan(session: HeadlessSession) -> tuple[LeveeLine, float, float, tuple[float, float]]:
    """Return the levee, when it is drawn and when compared [s], and where the front is when it is drawn."""
    shown = _shown(session.app)
    last = shown.timeline.index_before(shown.timeline.last_time)
    fronts = [
        (index, front) for index in range(1, last + 1) if (front := _front_at(session, index)) is not None
    ]
    if len(fronts) < 4:
        raise HeadlessError("the water reached no new ground, so there is no front to put a levee before")
    drawn, front = fronts[len(fronts) // 3]
    source = (front.row, front.col)
    ahead = [(at.row, at.col) for index, at in fronts if drawn < index <= drawn + 2 * (last - drawn) // 3]
    bed, later = shown.document.base, _depth(session, last)
    levee = place_levee(shown.grid, bed, ahead, _depth(session, drawn), later)
    if levee is None:
        raise HeadlessError("there is no place ahead of the front where a levee could hold the water")
    return levee, shown.timeline.time_of(drawn), shown.timeline.time_of(last), source


def _view_of(app: ViewerApp, levee: LeveeLine, source: tuple[float, float]) -> FlyTo:
    """Return the view of the levee from its dry side, towards the (row, col) the water comes from."""
    distance = max(2.2 * levee.length, 0.9 * _distance(_shown(app)))
    front = _shown(app).grid.center(*source)
    bearing = math.degrees(math.atan2(front[0] - levee.middle[0], front[1] - levee.middle[1]))
    return FlyTo(*levee.middle, distance, (bearing + 25.0) % 360.0, 36.0, 0.0)


def _draw(session: HeadlessSession, levee: LeveeLine) -> None:
    app = session.app
    app.carry_out(ChangeEditSettings(levee.width, levee.height, "raise", "modulate"))
    app.carry_out(BeginEdit())
    for point in (levee.start, levee.end):
        app.carry_out(AddVertex(*point))


def _recalculate(session: HeadlessSession) -> None:
    app = session.app
    app.carry_out(Recalculate())
    begun = app.recalculated
    session.pump(
        lambda: app.recalculated is None or not app.recalculated.is_waiting,
        "the first changed frame",
        120.0,
        0.0,
    )
    if begun is None or app.recalculated is not begun:
        raise HeadlessError(f"the recalculation was refused: {app.message}")
    app.carry_out(Seek((begun.index + 1) * _shown(app).info.output_interval))
    session.pump(
        lambda: begun.next_frame_s is not None or _step(app, begun.index), "the frame after it", 120.0, 0.0
    )


def _step(app: ViewerApp, index: int) -> bool:
    """Show the frame after the branch as soon as it is at hand; never ends the waiting."""
    shown = _shown(app)
    if index + 1 in shown.timeline:
        app.carry_out(Seek((index + 1) * shown.info.output_interval))
    return False


def _top_view(session: HeadlessSession) -> None:
    app = session.app
    app.carry_out(SetOption("water_colour", "depth"))
    app.carry_out(TopView())


def _shown(app: ViewerApp) -> ShownRun:
    if app.shown is None:
        raise HeadlessError("no run is shown")
    return app.shown


def _depth(session: HeadlessSession, index: int) -> npt.NDArray[np.float32]:
    key = _shown(session.app).frame_key(index)
    if not session.app.loader.wait([key], 30.0):
        raise HeadlessError(f"frame {index} could not be decoded")
    water = session.app.loader.get(key)
    assert water is not None
    return water.h


def _front_at(session: HeadlessSession, index: int) -> Front | None:
    if index not in _shown(session.app).timeline or index - 1 not in _shown(session.app).timeline:
        return None
    return find_front(_depth(session, index - 1), _depth(session, index))


def _distance(shown: ShownRun) -> float:
    return 0.16 * math.hypot(shown.grid.nrows, shown.grid.ncols) * shown.grid.dx


def _changed_share(before: Pixels, after: Pixels) -> float:
    difference = np.abs(before.astype(np.int16) - after.astype(np.int16)).max(axis=2)
    return float(np.mean(difference > CHANGED_LEVEL))


def _stamp(seconds: float) -> str:
    return time_text(seconds).replace(":", "").replace(" ", "_")
