"""What each command of a client does; the answer is sent here, errors are answered by the caller."""

from __future__ import annotations

from typing import Protocol

from protocol import (
    Ack,
    AppendEdit,
    AppendEdits,
    CaseList,
    ChangeForcing,
    Command,
    DeleteEdit,
    DeleteRun,
    GetChannel,
    GetImagery,
    GetSeries,
    GetTerrain,
    ListCases,
    ListRuns,
    PauseRun,
    PinRun,
    PresentView,
    Recalculate,
    RedoEdit,
    ReleaseControl,
    RenameRun,
    ReplaceEdit,
    ResumeRun,
    RunChanged,
    RunList,
    Seek,
    ServerMessage,
    ServerSession,
    StartRun,
    StopRun,
    Subscribe,
    TakeControl,
    Terrain,
    UndoEdit,
    UnpinRun,
    Unsubscribe,
    channel_parts,
    limits,
)
from solver_service.errors import RunError
from solver_service.runs import RunRegistry, Session
from solver_service.web.auth import Access
from solver_service.web.frame_feed import FrameFeed
from solver_service.web.imagery_parts import imagery_parts
from solver_service.web.outbox import Outbox
from solver_service.web.quotas import Quotas, owner_of

LISTED = 1000
LARGE_ANSWERS = 4
"""Terrains, pictures, channels and frames that may be on their way to a client when it asks for another."""

EditCommand = AppendEdit | AppendEdits | ReplaceEdit | DeleteEdit | UndoEdit | RedoEdit
"""Commands that change a working list of edits."""

CHANGES = (
    PauseRun
    | ResumeRun
    | StopRun
    | DeleteRun
    | RenameRun
    | PinRun
    | UnpinRun
    | EditCommand
    | ChangeForcing
    | Recalculate
)
"""Commands for which a session must control the run."""


class Client(Protocol):
    """What a command needs of the connection it came by."""

    registry: RunRegistry
    session: ServerSession
    feed: FrameFeed
    outbox: Outbox
    quotas: Quotas

    @property
    def identity(self) -> Session:
        """Who it is."""

    def find_session(self, name: str) -> Session | None:
        """Another connection by its id."""

    def tell(self, message: ServerMessage) -> None:
        """Queue one message."""


async def carry_out(command: Command, client: Client, access: Access) -> None:
    """Do what a command asks and answer it.

    Args:
        command: what is asked.
        client: the connection it came by.
        access: who asks.

    Raises:
        QuotaError: whoever is charged for it would take more than is allowed; nothing has changed.
        ServiceError: it cannot be done; nothing has changed.
        EditError: an edit does not fit.
    """
    registry = client.registry
    if isinstance(command, CHANGES):
        registry.tree.get(command.run)
        registry.controllers.claim(command.run, client.identity)
    match command:
        case ListCases():
            client.tell(CaseList(command.id, registry.cases[:LISTED]))
        case ListRuns():
            client.tell(RunList(command.id, registry.infos()[:LISTED]))
        case StartRun():
            async with client.quotas.start(access, command.case, command.device):
                run = await registry.control.start(
                    command.case,
                    command.duration,
                    command.output_interval,
                    command.device,
                    command.paused,
                    owner_of(access),
                    command.forcing,
                    command.channels,
                )
            registry.controllers.take(run.run, client.identity, force=True)
            client.tell(Ack(command.id, {"run": run.run}))
        case PauseRun():
            await registry.control.pause(command.run)
            client.tell(Ack(command.id))
        case ResumeRun():
            async with client.quotas.resume(registry.tree.get(command.run)):
                await registry.control.resume(command.run)
            client.tell(Ack(command.id))
        case StopRun():
            await registry.control.stop(command.run)
            client.tell(Ack(command.id))
        case DeleteRun():
            await registry.control.delete(command.run)
            client.tell(Ack(command.id))
        case RenameRun():
            await registry.control.rename(command.run, command.label)
            client.tell(Ack(command.id))
        case PinRun() | UnpinRun():
            await registry.control.pin(command.run, isinstance(command, PinRun))
            client.tell(Ack(command.id))
        case TakeControl():
            registry.tree.get(command.run)
            registry.controllers.take(command.run, client.identity, command.force)
            client.tell(Ack(command.id))
        case PresentView():
            if command.view is not None:
                registry.tree.get(command.view.run)
            registry.presentations.present(client.identity, command.view)
            client.tell(Ack(command.id))
        case ReleaseControl():
            _release(command, client)
            client.tell(Ack(command.id))
        case GetChannel():
            _refuse_who_does_not_read(client)
            packed = await registry.channels.read(command.run, command.index, command.channel)
            client.tell(Ack(command.id))
            parts = channel_parts(command.id, packed)
            client.outbox.put_bulk(packet for part in parts for packet in client.session.send(part))
        case GetSeries():
            _refuse_who_does_not_read(client)
            last, packed = await registry.channels.series(command.run, command.from_index)
            client.tell(Ack(command.id, {"index": last}))
            parts = channel_parts(command.id, packed)
            client.outbox.put_bulk(packet for part in parts for packet in client.session.send(part))
        case GetTerrain():
            await _send_terrain(command, client)
        case GetImagery():
            _refuse_who_does_not_read(client)
            pictures = await imagery_parts(command, registry)
            client.tell(Ack(command.id))
            client.outbox.put_bulk(packet for part in pictures for packet in client.session.send(part))
        case Subscribe() | Seek():
            registry.tree.get(command.run)
            client.tell(Ack(command.id))  # a subscription takes effect with its ack
            client.feed.follow_session()
            if isinstance(command, Subscribe):
                client.tell(RunChanged(registry.tree.info(registry.tree.get(command.run))))
                client.tell(registry.edits.changed(command.run))
                client.tell(registry.forcing.changed(command.run))
                for places in registry.tree.places(command.run):
                    client.tell(places)
                client.tell(registry.controllers.of(command.run))
        case Unsubscribe():
            client.tell(Ack(command.id))
            client.feed.follow_session()
        case AppendEdit() | AppendEdits() | ReplaceEdit() | DeleteEdit() | UndoEdit() | RedoEdit():
            client.quotas.edit(access, len(command.edits) if isinstance(command, AppendEdits) else 1)
            client.tell(Ack(command.id, {"revision": await _edit(command, registry)}))
        case ChangeForcing():
            client.quotas.edit(access, 1)
            revision = await registry.forcing.change(command.run, command.changes)
            client.tell(Ack(command.id, {"revision": revision}))
        case Recalculate():
            watched = client.feed.run
            run = registry.tree.get(command.run)
            async with client.quotas.branch(access, run, command.keep_parent):
                child = await registry.branching.recalculate(
                    command.run,
                    command.index,
                    command.revision,
                    command.keep_parent,
                    owner_of(access),
                    command.forcing_revision,
                )
            registry.controllers.take(child.run, client.identity, force=True)
            client.tell(Ack(command.id, {"run": child.run}))
            if watched == command.run:
                client.feed.move_to(child.run, command.index)
                client.tell(registry.forcing.changed(child.run))
                for places in registry.tree.places(child.run):
                    client.tell(places)


async def _edit(command: EditCommand, registry: RunRegistry) -> int:
    match command:
        case AppendEdit():
            return await registry.edits.append(command.run, command.edit)
        case AppendEdits():
            return await registry.edits.append(command.run, *command.edits)
        case ReplaceEdit():
            return await registry.edits.replace(command.run, command.edit)
        case DeleteEdit():
            return await registry.edits.delete(command.run, command.edit)
        case UndoEdit():
            return await registry.edits.undo(command.run)
        case RedoEdit():
            return await registry.edits.redo(command.run)


def _release(command: ReleaseControl, client: Client) -> None:
    registry = client.registry
    registry.tree.get(command.run)
    heir = client.find_session(command.to) if command.to is not None else None
    if command.to is not None and heir is None:
        raise RunError(f"there is no session {command.to!r} to control run {command.run}")
    registry.controllers.release(command.run, client.identity, heir)


def _refuse_who_does_not_read(client: Client) -> None:
    """Let nobody fill the memory of the service with large answers.

    Raises:
        RunError: too many are on their way.
    """
    if client.outbox.bulk_count >= LARGE_ANSWERS:
        raise RunError(f"{LARGE_ANSWERS} large answers are on their way; ask again when they have come")


async def _send_terrain(command: GetTerrain, client: Client) -> None:
    _refuse_who_does_not_read(client)
    packed = await client.registry.read_bed(command.run)
    grid = client.registry.tree.get(command.run).facts.grid
    client.tell(Ack(command.id))
    size = limits.PART_BYTES
    parts = -(-len(packed) // size)
    client.outbox.put_bulk(
        packet
        for part in range(parts)
        for packet in client.session.send(
            Terrain(
                id=command.id,
                run=command.run,
                part=part,
                parts=parts,
                shape=(grid.nrows, grid.ncols),
                codec="zstd-f32",
                data=packed[part * size : (part + 1) * size],
            )
        )
    )
