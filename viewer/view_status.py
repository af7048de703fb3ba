"""What panels, status line and scripts read of the viewer's state: plain frozen values."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime, timedelta

from viewer.units import METRIC, Units

__all__ = [
    "CaseRow",
    "EditRow",
    "EditSettings",
    "ForcingRow",
    "LegendRow",
    "PlaceRow",
    "PointReadout",
    "PresenterRow",
    "RunRow",
    "ViewStatus",
    "clock_text",
    "time_text",
]


def time_text(seconds: float) -> str:
    """Return a simulation time as `d hh:mm:ss`, the days only when there are any."""
    whole = int(seconds + 1e-6)
    days, rest = divmod(whole, 86_400)
    clock = f"{rest // 3600:02d}:{rest % 3600 // 60:02d}:{rest % 60:02d}"
    return f"{days}d {clock}" if days else clock


def clock_text(start_time: str | None, seconds: float) -> str:
    """Return the clock time of a simulation time, in the zone of the case; empty where it has no clock.

    Args:
        start_time: clock time of time 0, ISO 8601 with offset, or None.
        seconds: simulation time [s].
    """
    if start_time is None:
        return ""
    try:
        clock = datetime.fromisoformat(start_time) + timedelta(seconds=seconds)
    except (ValueError, OverflowError):
        return ""  # a service of another version may write it otherwise; no clock is better than a wrong one
    return clock.strftime("%Y-%m-%d %H:%M:%S %z").strip()


@dataclass(frozen=True)
class PlaceRow:
    """A gauge or section of the shown run.

    Attributes:
        id: its name.
        kind: "gauge" or "section".
    """

    id: str
    kind: str


@dataclass(frozen=True)
class CaseRow:
    """A case the service offers.

    Attributes:
        duration: the case's own length [s].
        output_interval: its own time between frames [s].
        cells: number of cells.
    """

    name: str
    title: str
    duration: float
    output_interval: float
    cells: int
    hypothetical: bool


@dataclass(frozen=True)
class RunRow:
    """A run or branch of the service.

    Attributes:
        branch_time: simulation time where it left its parent [s]; None for a run of its own.
        computed_until: time of its newest frame [s].
        label: the name that people gave it.
        pinned: whether it is kept whatever the budget of the store.
        moves: what its status allows now.
        controller: session and program of who controls it, as far as told; empty for nobody.
        asker: session that asked for its control; empty for nobody.
    """

    run: str
    parent: str | None
    case: str
    title: str
    status: str
    branch_time: float | None
    computed_until: float
    duration: float
    device: str
    label: str = ""
    pinned: bool = False
    moves: tuple[str, ...] = ()
    controller: tuple[str, str] = ("", "")
    asker: str = ""


@dataclass(frozen=True)
class ForcingRow:
    """Something that drives the flood of the shown run from outside.

    Attributes:
        kind: "source", "discharge", "stage", "rain" or "breach".
        unit: unit of its values.
        case_text: what the case says, in words.
        factor: what its values are multiplied by.
        offset: what is added to a level [m].
        series_text: the series that takes the place of the case's, in words; empty for the case's.
        start: when a breach begins [s], "never", or "case".
        case_start: when the case lets a breach begin, at the earliest [s].
        is_changed: whether it differs from the case.
        is_pending: whether the shown run was computed with something else.
    """

    id: str
    kind: str
    unit: str
    case_text: str
    factor: float = 1.0
    offset: float = 0.0
    series_text: str = ""
    start: float | str = "case"
    case_start: float = 0.0
    is_changed: bool = False
    is_pending: bool = False


@dataclass(frozen=True)
class EditSettings:
    """What an edit is, or the next one will be.

    Attributes:
        width: width of a line [m].
        magnitude: height of the change [m].
        operation: "raise" or "lower".
        type: "modulate" or "replace".
        level: elevation of the crest or floor [m], for "replace" with `at_level`.
        at_level: whether "replace" means that elevation, not the magnitude above the ground.
    """

    width: float = 40.0
    magnitude: float = 8.0
    operation: str = "raise"
    type: str = "modulate"
    level: float = 0.0
    at_level: bool = False


@dataclass(frozen=True)
class EditRow:
    """An edit of the working list, or one that was undone.

    Attributes:
        text: what it is, in words.
        is_applied: the shown run was computed with it.
        measure: length and volume in words.
        warning: when and where it was first seen overtopped, in words; empty when it was not.
        name: the name that people gave it.
        kind: "line" or "area".
        settings: its numbers.
        centre: the middle of what it covers, x and y [m].
    """

    id: str
    text: str
    is_applied: bool
    measure: str = ""
    warning: str = ""
    name: str = ""
    kind: str = "line"
    settings: EditSettings = field(default_factory=EditSettings)
    centre: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class LegendRow:
    """A class of the water: sRGB colour and what it stands for."""

    colour: tuple[int, int, int]
    text: str


@dataclass(frozen=True)
class PresenterRow:
    """A session that shows its view to the others: its id and the name of its program."""

    session: str
    client: str


@dataclass(frozen=True)
class PointReadout:
    """Water and ground at a map point: depth [m], water level and ground elevation [m above the datum].

    Attributes:
        speed: of the water [m/s]; None where it is not known.
        bearing: compass bearing toward which it flows [deg]; None where it stands or is not known.
    """

    x: float
    y: float
    ground: float
    depth: float
    level: float | None
    speed: float | None = None
    bearing: float | None = None


@dataclass(frozen=True)
class ViewStatus:
    """The whole state that is shown outside the picture.

    Attributes:
        connection: one sentence about the connection.
        address: websocket address of the service.
        server: name and version of the service, empty before it said them.
        session: the name the service gave this connection.
        received_bytes: bytes that came in since the viewer started.
        received_bit_s: bits a second that come in now.
        message: the newest notice, error or result, one sentence.
        time: playback time [s].
        clock: clock time of the playback time in words, empty where the case has no clock.
        data_age: since the service was last heard [s]; None when it never was.
        is_measuring: whether the measuring tool is in the hand.
        measured: what it says in words, empty before there are two points.
        presenters: the sessions that show their view.
        is_presenting: whether this viewer shows its view.
        followed: session whose view is followed, None flies freely.
        revision: revision of the working list of edits.
        units: units of everything written.
        computed_until: time of the newest frame of the shown run [s].
        branch_time: where the shown run left its parent [s], None when it has none.
        speed_x_real_time: simulated seconds per wall second of the computation.
        undone_edits: edits that redoing would bring back, the next one first.
        edit_tool: the tool in the user's hand: "line", "area", "select", "level", or empty.
        selected_edit: id of the selected edit.
        compare_mode: how it is compared, "difference" or "swipe".
        swipe_at: where the divider stands, as a share of the width; None when there is none.
        water_colour: what the water is to be coloured by.
        water_colours: what the shown run lets it be coloured by.
        water_note: why the colours wanted are not there yet, one sentence.
        legend: classes on the picture, lowest first; empty for natural water.
        recalculate_latency_s: from the last Recalculate to its first changed frame on the picture [s].
        depth_record: (times [s], depths [m]) at the probed point, frames loaded so far.
        speed_record: (times [s], speeds [m/s]) there, as far as velocity has come.
        discharge_record: (times [s], discharges [m3/s]) of the chosen section.
        places: gauges and sections of the shown run.
        series_of: the one whose full-rate records these are; None where they are the probed point's.
        other_discharge_record: the same of the run that is compared with.
        other_depth_record: the same of the run that is compared with.
        other_speed_record: the same of the run that is compared with.
    """

    connection: str = "not connected"
    is_connected: bool = False
    address: str = ""
    server: str = ""
    session: str = ""
    received_bytes: int = 0
    received_bit_s: float = 0.0
    message: str = ""
    devices: tuple[str, ...] = ()
    cases: tuple[CaseRow, ...] = ()
    runs: tuple[RunRow, ...] = ()
    shown_run: str | None = None
    forcing: tuple[ForcingRow, ...] = ()
    compared_run: str | None = None
    compare_mode: str = "difference"
    swipe_at: float | None = None
    title: str = ""
    hypothetical: bool = False
    has_terrain: bool = False
    time: float = 0.0
    clock: str = ""
    data_age: float | None = None
    revision: int = 0
    units: Units = METRIC
    computed_until: float = 0.0
    duration: float = 0.0
    output_interval: float = 0.0
    branch_time: float | None = None
    is_playing: bool = False
    follows_live: bool = False
    loops: bool = False
    presenters: tuple[PresenterRow, ...] = ()
    is_presenting: bool = False
    followed: str | None = None
    playback_speed: float = 1.0
    is_drawing: bool = False
    is_measuring: bool = False
    measured: str = ""
    drawn_vertices: int = 0
    edit_settings: EditSettings = field(default_factory=EditSettings)
    edits: tuple[EditRow, ...] = ()
    undone_edits: tuple[EditRow, ...] = ()
    edit_tool: str = ""
    selected_edit: str | None = None
    can_undo: bool = False
    can_redo: bool = False
    can_recalculate: bool = False
    is_recalculating: bool = False
    recalculate_latency_s: float | None = None
    hover: PointReadout | None = None
    probe: PointReadout | None = None
    depth_record: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    speed_record: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    other_depth_record: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    other_speed_record: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    places: tuple[PlaceRow, ...] = ()
    series_of: PlaceRow | None = None
    discharge_record: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    other_discharge_record: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    speed_x_real_time: float | None = None
    volume_error_relative: float | None = None
    options: tuple[tuple[str, bool | float | str], ...] = ()
    water_colour: str = "natural"
    water_colours: tuple[str, ...] = ("natural", "depth")
    water_note: str = ""
    legend: tuple[LegendRow, ...] = ()
    flow_arrows: bool = False
