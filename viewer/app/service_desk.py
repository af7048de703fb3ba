"""The viewer's dealings with the service: what is asked of it, and who hears what it says."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Protocol, cast

import protocol
from viewer.app.run_book import RunBook
from viewer.app.service_link import Refusal, Reply, ServiceLink
from viewer.net import ConnectionThread

__all__ = ["ServiceDesk", "ServiceListener"]

CREDIT = 16
"""Frames that may be on their way at a time."""


class ServiceListener(Protocol):
    """Who is told what the service says.

    Attributes:
        is_stale: set whenever anything was said.
    """

    is_stale: bool

    def connection_opened(self) -> None:
        """A connection stands, the first one or one after a loss."""

    def run_changed(self, info: protocol.RunInfo) -> None:
        """A run is new or has changed."""

    def edits_changed(self, message: protocol.EditsChanged) -> None:
        """The working list of a run has changed."""

    def view_presented(self, message: protocol.ViewPresented) -> None:
        """A session shows its view, or no longer."""

    def terrain_came(self, message: protocol.TerrainReceived) -> None:
        """The base bed of a run is here."""

    def picture_came(self, message: protocol.ImageryReceived) -> None:
        """A picture of the terrain of a run is here."""

    def say(self, sentence: str) -> None:
        """Show a sentence to the user."""


class ServiceDesk:
    """Sends requests, sorts what comes in, keeps the book of runs.

    Args:
        connection: the connection to the service.
        listener: who is told.

    Attributes:
        book: what is known of its cases and runs.
        devices: devices that a run may ask for.
        server: name and version of the service; empty before it said them.
        session: the name the service gave this connection.
        channel_came: called with every channel that comes.
        series_came: called with all series that come.
    """

    def __init__(self, connection: ConnectionThread, listener: ServiceListener) -> None:
        self.connection = connection
        self.book = RunBook()
        self.devices: tuple[str, ...] = ()
        self._listener = listener
        self._link = ServiceLink(connection, listener.say)
        self._heard_at: float | None = None
        self.channel_came: Callable[[protocol.ChannelReceived], None] = lambda message: None
        self.series_came: Callable[[protocol.SeriesReceived], None] = lambda message: None
        self._awaits_welcome = False
        self.server = ""
        self.session = ""

    @property
    def is_open(self) -> bool:
        """Whether commands can leave."""
        return self.connection.state.phase == "open"

    def connection_sentence(self) -> str:
        """Return what the connection does, with the countdown to the next attempt."""
        return self.connection.state.sentence(time.monotonic())

    def data_age(self, now: float) -> float | None:
        """Seconds since the connection last stood, at `time.monotonic()` = `now`; None before it ever did."""
        return None if self._heard_at is None else max(0.0, now - self._heard_at)

    def change_service(self, url: str, token: str | None) -> None:
        """Leave the service for another one; all that is known of this one's runs is forgotten."""
        self._awaits_welcome = True
        self._link.forget()
        self.book.clear()
        self.devices = ()
        self.server = self.session = ""
        self._heard_at = None
        self.connection.change_service(url, token)

    def drain(self) -> list[protocol.Frame]:
        """Act on every waiting control message; return the frames that came, and let as many more come."""
        if self.is_open:
            self._heard_at = time.monotonic()
        # Frames first: what was said before a frame came is then known before it is used.
        frames = self.connection.mailbox.take_frames()
        for message in self.connection.mailbox.take_control():
            self._listener.is_stale = True
            if self._awaits_welcome and not isinstance(message, protocol.Welcome):
                continue  # said by the service that was left
            self._handle(message)
        if self._awaits_welcome:
            return []
        if frames:
            self._link.grant(len(frames))
        return frames

    def start_run(
        self,
        case: str,
        duration: float | None,
        interval: float | None,
        device: str,
        forcing: tuple[protocol.ForcingChange, ...],
        done: Reply,
        refused: Refusal,
    ) -> None:
        """Ask for a new run."""
        self._link.send(
            lambda number: protocol.StartRun(
                number,
                case=case,
                duration=duration,
                output_interval=interval,
                device=device,
                forcing=forcing,
            ),
            f"start {case}",
            done,
            refused,
        )

    def ask(
        self,
        make: Callable[[int], protocol.ClientMessage],
        what: str,
        done: Reply | None = None,
        refused: Refusal | None = None,
    ) -> None:
        """Send the command that `make` builds around a fresh id; see `ServiceLink.send`."""
        self._link.send(make, what, done, refused)

    def fetch_terrain(self, info: protocol.RunInfo) -> None:
        """Ask for the base bed of a run, and for what pictures there are of it."""
        run = info.run
        # Walls are small and change how the ground is drawn, so they go ahead of it.
        if "walls" in info.layers:
            self._fetch_picture(run, "walls")
        self._link.send(lambda number: protocol.GetTerrain(number, run=run), "fetch the terrain")
        if "imagery" in info.layers:
            self._fetch_picture(run, "imagery")

    def fetch_channel(
        self, run: str, index: int, channel: str, numbered: Callable[[int], None], refused: Refusal
    ) -> bool:
        """Ask for a channel of a frame; return whether the request left.

        Args:
            run: id of the run.
            index: frame index.
            channel: its name.
            numbered: told the number that the answer will bear (see `channel_came`).
            refused: told why there will be no answer.
        """

        def make(number: int) -> protocol.GetChannel:
            numbered(number)
            return protocol.GetChannel(
                number, run=run, index=index, channel=cast(protocol.ChannelName, channel)
            )

        return self._link.send(make, f"fetch the {channel}", refused=refused)

    def fetch_series(
        self, run: str, from_index: int, numbered: Callable[[int], None], refused: Refusal
    ) -> None:
        """Ask for what gauges and sections recorded from a frame on; see `fetch_channel`."""

        def make(number: int) -> protocol.GetSeries:
            numbered(number)
            return protocol.GetSeries(number, run=run, from_index=from_index)

        self._link.send(make, "fetch the series", refused=refused)

    def subscribe(self, run: str, from_index: int, mode: protocol.SubscriptionMode) -> None:
        """Ask for the frames of a run from an index on."""
        self._link.send(
            lambda number: protocol.Subscribe(
                number, run=run, from_index=from_index, mode=mode, credit=CREDIT
            ),
            "subscribe to the run",
        )

    def seek(self, run: str, index: int) -> None:
        """Ask the stream to go on from another frame."""
        self._link.send(lambda number: protocol.Seek(number, run=run, index=index), "fetch a frame")

    def append_edits(self, run: str, edits: Sequence[protocol.Edit], done: Reply, refused: Refusal) -> None:
        """Ask to take edits into the working list, all or none."""
        one, *more = edits
        self._link.send(
            lambda number: (
                protocol.AppendEdits(number, run=run, edits=tuple(edits))
                if more
                else protocol.AppendEdit(number, run=run, edit=one)
            ),
            "add the edits" if more else "add the edit",
            done,
            refused,
        )

    def replace_edit(self, run: str, edit: protocol.Edit, done: Reply, refused: Refusal) -> None:
        """Ask to put an edit in the place of the one of its id."""
        self._link.send(
            lambda number: protocol.ReplaceEdit(number, run=run, edit=edit), "change the edit", done, refused
        )

    def present_view(self, view: protocol.View | None) -> None:
        """Ask to show a view to all other sessions; None ends it."""
        self._link.send(lambda number: protocol.PresentView(number, view=view), "present the view")

    def delete_edit(self, run: str, edit: str, done: Reply, refused: Refusal) -> None:
        """Ask to take an edit out of the working list."""
        self._link.send(
            lambda number: protocol.DeleteEdit(number, run=run, edit=edit), "delete the edit", done, refused
        )

    def undo_edit(self, run: str, done: Reply, refused: Refusal) -> None:
        """Ask to take the newest change of the working list back."""
        self._link.send(lambda number: protocol.UndoEdit(number, run=run), "undo", done, refused)

    def redo_edit(self, run: str, done: Reply, refused: Refusal) -> None:
        """Ask to make the change taken back last again."""
        self._link.send(lambda number: protocol.RedoEdit(number, run=run), "redo", done, refused)

    def recalculate(
        self,
        run: str,
        index: int,
        revision: int,
        forcing_revision: int | None,
        done: Reply,
        refused: Refusal,
    ) -> None:
        """Ask for a branch at a frame with the working list of edits and the working forcing."""
        self._link.send(
            lambda number: protocol.Recalculate(
                number, run=run, index=index, revision=revision, forcing_revision=forcing_revision
            ),
            "recalculate",
            done,
            refused,
        )

    def close(self) -> None:
        """End the connection."""
        self.connection.close()

    def _fetch_picture(self, run: str, layer: protocol.Layer) -> None:
        self._link.send(
            lambda number: protocol.GetImagery(number, run=run, layer=layer),
            f"fetch the {layer} of the terrain",
        )

    def _handle(self, message: protocol.ClientEvent) -> None:
        match message:
            case protocol.Welcome():
                self._awaits_welcome = False
                self.server, self.session = f"{message.server} {message.version}", message.session
                self._link.forget()
                self.devices = tuple(message.devices)
                self._link.send(lambda number: protocol.ListCases(number), "list the cases")
                self._link.send(lambda number: protocol.ListRuns(number), "list the runs")
                self._listener.connection_opened()
            case protocol.Ack():
                self._link.handle_ack(message)
            case protocol.Error():
                self._link.handle_error(message)
            case protocol.CaseList():
                self._link.handle_listing(message.id)
                self.book.cases = tuple(message.cases)
            case protocol.RunList():
                self._link.handle_listing(message.id)
                for info in reversed(message.runs):
                    self._note_run(info)
            case protocol.RunChanged():
                self._note_run(message.run)
            case protocol.RunRemoved():
                self.book.remove(message.run)
            case protocol.Places():
                self.book.places[message.run] = message
            case protocol.ForcingChanged():
                self.book.forcing[message.run] = message
            case protocol.ControlChanged():
                self.book.note_control(message)
            case protocol.ControlRequested():
                self.book.control_requests[message.run] = message
                asker = message.client or "another session"
                self._listener.say(f"{asker} ({message.session}) asks for the control of this run")
            case protocol.RunBranched():
                self._note_run(message.child)
                self._listener.say("somebody recalculated this run; the branch is in the list of runs")
            case protocol.EditsChanged():
                self.book.note_edits(message)
                self._listener.edits_changed(message)
            case protocol.TerrainReceived():
                self._listener.terrain_came(message)
            case protocol.ImageryReceived():
                self._listener.picture_came(message)
            case protocol.ChannelReceived():
                self.channel_came(message)
            case protocol.SeriesReceived():
                self.series_came(message)
            case protocol.Progress():
                self.book.progress[message.run] = message
            case protocol.ViewPresented():
                self._listener.view_presented(message)
            case protocol.Notice():
                self._listener.say(message.text)

    def _note_run(self, info: protocol.RunInfo) -> None:
        before = self.book.runs.get(info.run)
        self.book.note_run(info)
        if info.status == "failed" and info.message and (before is None or before.status != "failed"):
            self._listener.say(f"the run failed: {info.message}")
        self._listener.run_changed(self.book.runs[info.run])
