"""One or two examples of every message; the golden bytes are theirs."""

from typing import get_args

import msgspec
from msgspec import structs

import protocol as p
from protocol import Message

LINE = p.EditLine(
    id="levee-1",
    vertices=((100.0, 250.5), (180.0, 260.0), (240.25, 300.0)),
    width=12.5,
    operation=p.Operation.raise_,
    type=p.EditType.replace,
    magnitude=3.0,
    reference_z=(4.5, 5.0, 5.25),
)
AREA = p.EditArea(
    id="pit",
    vertices=((10.0, 10.0), (40.0, 12.0), (30.0, 44.0)),
    operation=p.Operation.lower,
    type=p.EditType.modulate,
    magnitude=1.5,
    level=None,
)
NAMED = msgspec.structs.replace(LINE, name="Levee north")
GRID = p.GridInfo(
    nrows=120,
    ncols=200,
    dx=30.0,
    x0=-500.0,
    y0=1000.0,
    crs="EPSG:32616",
    vertical_datum="NGVD29",
    datum_offset=300.0,
)
RUN = p.RunInfo(
    run="r-1",
    case="jacksboro",
    title="A dam breaks above Jacksboro",
    status="running",
    grid=GRID,
    duration=3600.0,
    output_interval=10.0,
    frame_count=12,
    device="cpu",
    hypothetical=True,
    depth_wet=0.001,
    lineage=(p.LineageEntry("r-1", 0),),
    source="USGS",
    licence="public domain",
)
CHILD = p.RunInfo(
    run="r-2",
    case="jacksboro",
    title="A dam breaks above Jacksboro",
    status="failed",
    grid=GRID,
    duration=3600.0,
    output_interval=10.0,
    frame_count=8,
    device="cuda:0",
    hypothetical=True,
    depth_wet=0.001,
    parent="r-1",
    branch_index=7,
    revision=1,
    lineage=(p.LineageEntry("r-1", 0), p.LineageEntry("r-2", 7)),
    start_time="1959-12-02T21:14:00+01:00",
    message="The water blew up.",
    label="with the levee",
    pinned=True,
)
CASE = p.CaseSummary(
    name="jacksboro",
    title="A dam breaks above Jacksboro",
    hypothetical=True,
    nrows=120,
    ncols=200,
    dx=30.0,
    duration=3600.0,
    output_interval=10.0,
    source="USGS",
    licence="public domain",
)

CHANGES = (
    p.ForcingChange("spring", factor=1.5),
    p.ForcingChange("west-1", series=p.ForcingSeries((0.0, 600.0), (20.0, 35.5))),
    p.ForcingChange("sea", offset=0.5),
    p.ForcingChange("dam", start_time=900.0),
    p.ForcingChange("dike", start_time="never"),
)
ITEMS = (
    p.ForcingItem("spring", "source", "m3/s", 0.0, 1e4, p.ForcingSeries((0.0,), (19.75,))),
    p.ForcingItem("west-1", "discharge", "m3/s", -1e4, 1e4, p.ForcingSeries((0.0, 60.0), (0.0, 12.5))),
    p.ForcingItem("sea", "stage", "m", -100.0, 100.0, p.ForcingSeries((0.0,), (2.5,))),
    p.ForcingItem("rain", "rain", "mm/h", 0.0, 1e4),
    p.ForcingItem("dam", "breach", "s", start_time=300.0),
    p.ForcingItem("dike", "breach", "s", start_time=0.0, overtopping=True),
)

VIEW = p.View("r-1", 120.0, 382000.0, 6354000.0, 2500.0, 45.0, 30.0, True, 60.0)

CLIENT_EXAMPLES: dict[str, Message] = {
    "hello": p.Hello(client="test 1.0", versions=("fev.v1",), capabilities=("depth", "edits")),
    "hello-resume": p.Hello(
        client="test 1.0",
        token="s3cret",
        resume=p.ResumePoint(run="r-1", last_index=11, revision=2, session="c0ffee"),
        capabilities=(),
    ),
    "list_cases": p.ListCases(1),
    "list_runs": p.ListRuns(2),
    "start_run": p.StartRun(3, "jacksboro"),
    "start_run-full": p.StartRun(3, "malpasset", 4000.0, 20.0, "cuda:1", True),
    "pause_run": p.PauseRun(4, "r-1"),
    "resume_run": p.ResumeRun(5, "r-1"),
    "stop_run": p.StopRun(6, "r-1"),
    "get_terrain": p.GetTerrain(7, "r-1"),
    "get_imagery": p.GetImagery(30, "r-1"),
    "get_imagery-walls": p.GetImagery(31, "r-1", "walls"),
    "get_series": p.GetSeries(31, "r-1", 12),
    "get_channel": p.GetChannel(29, "r-1", 33, "velocity"),
    "start_run-channels": p.StartRun(30, "jacksboro", channels=("maxima",)),
    "subscribe": p.Subscribe(8, "r-1", 0, "live", 2),
    "unsubscribe": p.Unsubscribe(9),
    "seek": p.Seek(10, "r-1", 5),
    "credit": p.Credit(1),
    "append_edit": p.AppendEdit(11, "r-1", LINE),
    "append_edit-area": p.AppendEdit(12, "r-1", AREA),
    "append_edit-named": p.AppendEdit(13, "r-1", NAMED),
    "append_edits": p.AppendEdits(14, "r-1", (LINE, AREA)),
    "replace_edit": p.ReplaceEdit(15, "r-1", NAMED),
    "delete_edit": p.DeleteEdit(16, "r-1", "pit"),
    "undo_edit": p.UndoEdit(13, "r-1"),
    "redo_edit": p.RedoEdit(14, "r-1"),
    "recalculate": p.Recalculate(15, "r-1", 7, 1),
    "start_run-forcing": p.StartRun(3, "jacksboro", forcing=CHANGES[:1]),
    "change_forcing": p.ChangeForcing(27, "r-1", CHANGES),
    "recalculate-forcing": p.Recalculate(28, "r-1", 7, 1, False, 2),
    "rename_run": p.RenameRun(16, "r-1", "with the levee"),
    "pin_run": p.PinRun(17, "r-1"),
    "unpin_run": p.UnpinRun(18, "r-1"),
    "delete_run": p.DeleteRun(19, "r-1"),
    "take_control": p.TakeControl(20, "r-1", True),
    "present_view": p.PresentView(22, VIEW),
    "present_view-end": p.PresentView(23),
    "release_control": p.ReleaseControl(21, "r-1", "c0ffee"),
}

SERVER_EXAMPLES: dict[str, Message] = {
    "welcome": p.Welcome(
        protocol="fev.v1",
        server="fev-solver",
        version="0.1.0",
        session="c0ffee",
        capabilities=("depth", "edits"),
        devices=("cpu", "cuda:0"),
    ),
    "ack": p.Ack(3, {"run": "r-1"}),
    "ack-empty": p.Ack(4),
    "error": p.Error(15, "not_computed", "Frame 9 of run 'r-1' is not computed yet."),
    "error-closing": p.Error(None, "malformed", "A message is cut short."),
    "case_list": p.CaseList(1, (CASE,)),
    "run_list": p.RunList(2, (RUN, CHILD)),
    "run_changed": p.RunChanged(RUN),
    "run_branched": p.RunBranched("r-1", CHILD),
    "terrain": p.Terrain(7, "r-1", 0, 2, (120, 200), "zstd-f32", bytes(range(16))),
    "edits_changed": p.EditsChanged("r-1", 2, (LINE, AREA), True, False),
    "edits_changed-undone": p.EditsChanged("r-1", 4, (NAMED,), True, True, (AREA,)),
    "frame": p.Frame("r-1", 33, 330.0, 1, 32, 0.001, b"\x1b\x02", 6, 0xDEADBEEF, bytes(range(12))),
    "imagery_part": p.ImageryPart(30, "r-1", "imagery", 0, 2, bytes(range(8))),
    "frame-planes": p.Frame(
        "r-1", 33, 330.0, 1, 32, 0.001, b"\x1b\x02", 6, 0xDEADBEEF, bytes(range(12)), codec="planes"
    ),
    "channel_part": p.ChannelPart(29, 0, 2, bytes(range(8))),
    "run_changed-channels": p.RunChanged(structs.replace(RUN, channels=("velocity", "maxima"))),
    "frame-breached": p.Frame(
        "r-1",
        33,
        330.0,
        1,
        32,
        0.001,
        b"\x1b\x02",
        6,
        0xDEADBEEF,
        bytes(range(12)),
        bytes.fromhex("05000000c9000000"),
        bytes.fromhex("0000c03f000080bf"),
    ),
    "frame_part": p.FramePart("r-1", 33, 1, 2, bytes(range(8))),
    "progress": p.Progress("r-1", 331.5, 1200, 0.25, 40.0, 8.3, 3.5e6, -1e-9, 4021, (60, 100), 86.5),
    "water_budget": p.WaterBudget(
        "r-1",
        331.5,
        initial=1000.0,
        stored=1500.0,
        inflow=900.0,
        outflow=300.0,
        rain=10.0,
        infiltration=110.0,
        edits=0.0,
        error=1e-6,
        error_relative=5e-10,
        sources={"spring": 400.0},
        edges_in={"west-1": 450.0},
        edges_out={"west-1": 0.0, "east-1": 300.0},
        structures={"pump": -50.0},
        moved={"culvert": 12.5},
    ),
    "forcing_changed": p.ForcingChanged("r-1", 2, CHANGES, CHANGES[:1], ITEMS),
    "places": p.Places(
        "r-1",
        (p.GaugePlace("town", 740_305.0, 4_014_205.0),),
        (p.SectionPlace("behind the levee", ((740_230.0, 4_014_000.0), (740_230.0, 4_014_400.0))),),
    ),
    "run_removed": p.RunRemoved("r-2"),
    "control_changed": p.ControlChanged("r-1", "c0ffee", "fev-viewer 0.1.0"),
    "control_requested": p.ControlRequested("r-1", "decaf", "fev-viewer 0.1.0"),
    "view_presented": p.ViewPresented("c0ffee", "fev-viewer 0.1.0", VIEW),
    "notice": p.Notice("warning", "The disk is nearly full.", "r-1"),
}

EXAMPLES = CLIENT_EXAMPLES | SERVER_EXAMPLES

CLIENT_KINDS: tuple[type[Message], ...] = get_args(p.ClientMessage)
SERVER_KINDS: tuple[type[Message], ...] = get_args(p.ServerMessage)
