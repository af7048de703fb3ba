"""The viewer's state as the panels and scripts read it."""

from __future__ import annotations

import dataclasses

from viewer.app.edit_report import edit_rows, undone_rows
from viewer.app.editing import Editing
from viewer.app.forcing_work import ForcingWork, forcing_rows
from viewer.app.levee_watch import LeveeWatch
from viewer.app.picture_text import readout
from viewer.app.recalculation import Recalculation
from viewer.app.service_desk import ServiceDesk
from viewer.app.shown_run import ShownRun
from viewer.app.water_feed import WaterFeed
from viewer.net import FrameLoader
from viewer.view_status import PointReadout, ViewStatus, clock_text
from viewer.world import PlaybackClock, probe

__all__ = ["depth_record", "point_readout", "program_status", "run_status"]


def program_status(desk: ServiceDesk, clock: PlaybackClock, editing: Editing, message: str) -> ViewStatus:
    """Return the part of the status that needs no run."""
    return ViewStatus(
        connection=desk.connection_sentence(),
        is_connected=desk.is_open,
        address=desk.connection.url,
        server=desk.server,
        session=desk.session,
        message=message,
        devices=desk.devices,
        cases=desk.book.case_rows(),
        runs=desk.book.run_rows(),
        is_playing=clock.is_playing,
        follows_live=clock.follows_live,
        playback_speed=clock.speed,
        time=clock.time,
        is_drawing=editing.drawing.is_on,
        drawn_vertices=len(editing.drawing.vertices),
        edit_settings=editing.drawing.settings,
        edit_tool=editing.tool,
        selected_edit=editing.selection.selected,
    )


def run_status(
    status: ViewStatus,
    shown: ShownRun,
    desk: ServiceDesk,
    recalculated: Recalculation | None,
    watch: LeveeWatch,
    forcing: ForcingWork,
) -> ViewStatus:
    """Return `status` with what is known of the shown run."""
    info, document = shown.info, shown.document
    progress = desk.book.progress.get(shown.run)
    is_waiting = recalculated is not None and recalculated.is_waiting
    return dataclasses.replace(
        status,
        shown_run=shown.run,
        forcing=forcing_rows(desk.book.forcing.get(shown.run), forcing.changes(shown.run)),
        title=info.title,
        hypothetical=info.hypothetical,
        has_terrain=True,
        clock=clock_text(info.start_time, status.time),
        revision=document.revision,
        computed_until=shown.computed_until,
        duration=info.duration,
        output_interval=info.output_interval,
        branch_time=None if info.branch_index is None else info.branch_index * info.output_interval,
        edits=edit_rows(shown, desk.book.edits_below(shown.run, document.revision), watch, status.units),
        undone_edits=undone_rows(shown, status.units),
        can_undo=document.can_undo and desk.is_open,
        can_redo=document.can_redo and desk.is_open,
        can_recalculate=desk.is_open and len(shown.timeline) > 0 and not is_waiting,
        is_recalculating=is_waiting,
        recalculate_latency_s=None if recalculated is None else recalculated.first_frame_s,
        speed_x_real_time=None if progress is None else progress.speed_x_real_time,
        volume_error_relative=None if progress is None else progress.volume_error_relative,
    )


def depth_record(shown: ShownRun, loader: FrameLoader) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return times [s] and depths [m] at the traced point in the frames of the shown run read so far."""
    traced = loader.traced()
    read = [traced[key] for index in shown.timeline.indices if (key := shown.frame_key(index)) in traced]
    return tuple(time for time, _ in read), tuple(depth for _, depth in read)


def point_readout(shown: ShownRun, feed: WaterFeed, at: tuple[float, float] | None) -> PointReadout | None:
    """Return ground and water at a map point, None without a point or outside the terrain."""
    if at is None:
        return None
    depths = feed.depths()
    if depths is None:
        return readout(probe(shown.heightfield, *at))
    first, second, alpha = depths
    return readout(probe(shown.heightfield, *at, first, second, alpha))
