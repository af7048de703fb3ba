"""The program in one piece: service, connection, state machine, and a window or a headless flight over it."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from viewer.app.endpoint import Endpoint, stream_url
from viewer.app.headless import HeadlessSession
from viewer.app.local_service import LocalService, LocalServiceError
from viewer.app.script import read_script
from viewer.app.summary import FlightSummary, summarise, table_text, write_summary
from viewer.app.tour import fly_tour
from viewer.app.viewer_app import ViewerApp
from viewer.commands import StartRun
from viewer.errors import ConnectionLost
from viewer.net import ConnectionThread, FrameLoader

__all__ = ["ViewerJob", "fly_headless", "open_window"]


@dataclass(frozen=True)
class ViewerJob:
    """What is to be done.

    Attributes:
        endpoint: where the service is.
        start: the run to start once connected, None to start nothing.
        started: wall time at which the program began [s, monotonic].
    """

    endpoint: Endpoint
    start: StartRun | None
    started: float


def open_window(job: ViewerJob) -> int:
    """Open the window; return the exit status once it is closed.

    Raises:
        ViewerError: the service does not start, or there can be no window.
    """
    from viewer.app.window import prepare_window, run_window  # Qt loads only for a window

    prepare_window()
    with _program(job) as (app, _service):
        return run_window(app, app.close)


def fly_headless(job: ViewerJob, folder: Path, script: Path | None) -> FlightSummary:
    """Fly without a window: pictures, contact sheet and summary go to `folder`.

    Raises:
        ViewerError: something that was waited for did not come; the text says what.
    """
    steps = None if script is None else read_script(script)
    with _program(job) as (app, service):

        def watch() -> None:
            if service is not None and not service.is_running:
                raise LocalServiceError(
                    f"the solver service ended: {service.last_words or 'it said nothing'}"
                )
            if app.desk.connection.state.phase == "refused":
                raise ConnectionLost(app.desk.connection.state.text)

        session = HeadlessSession(app, folder, watch=watch)
        try:
            if steps is None:
                summary = fly_tour(session, job.started)
            else:
                session.follow(steps)
                run = next(iter(app.desk.book.runs), None)
                summary = summarise(app, session, run, job.started)
                summary.total_wall_s = round(time.monotonic() - job.started, 2)
        finally:
            session.close()
    write_summary(summary, folder / "summary.json")
    print(table_text(summary))
    return summary


@contextmanager
def _program(job: ViewerJob) -> Iterator[tuple[ViewerApp, LocalService | None]]:
    """Start service, connection and state machine; end them in the reverse order."""
    service: LocalService | None = None
    endpoint = job.endpoint
    if endpoint.url is None:
        case = [] if job.start is None else ["--case", job.start.case]
        service = LocalService(endpoint.data_dir, case)
        endpoint = Endpoint(service.url, service.token)
    try:
        assert endpoint.url is not None
        connection = ConnectionThread(stream_url(endpoint.url), endpoint.token)
        app = ViewerApp(connection, FrameLoader(), job.start)
        connection.start()
        try:
            yield app, service
        finally:
            app.close()
    finally:
        if service is not None:
            service.close()
