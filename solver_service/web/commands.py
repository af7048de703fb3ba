"""What each command of a client does; the answer is sent here, errors are answered by the caller."""

from __future__ import annotations

from typing import Protocol

from protocol import (
    Ack,
    AppendEdit,
    CaseList,
    Command,
    GetTerrain,
    ListCases,
    ListRuns,
    PauseRun,
    Recalculate,
    RedoEdit,
    ResumeRun,
    RunChanged,
    RunList,
    Seek,
    ServerMessage,
    ServerSession,
    StartRun,
    StopRun,
    Subscribe,
    Terrain,
    UndoEdit,
    Unsubscribe,
    limits,
)
from solver_service.runs import RunRegistry
from solver_service.web.frame_feed import FrameFeed
from solver_service.web.outbox import Outbox

LISTED = 1000


class Client(Protocol):
    """What a command needs of the connection it came by."""

    registry: RunRegistry
    session: ServerSession
    feed: FrameFeed
    outbox: Outbox

    def tell(self, message: ServerMessage) -> None:
        """Queue one message."""


async def carry_out(command: Command, client: Client) -> None:
    """Do what a command asks and answer it.

    Raises:
        ServiceError: it cannot be done; nothing has changed.
        EditError: an edit does not fit.
    """
    registry = client.registry
    match command:
        case ListCases():
            client.tell(CaseList(command.id, registry.cases[:LISTED]))
        case ListRuns():
            client.tell(RunList(command.id, registry.infos()[:LISTED]))
        case StartRun():
            run = await registry.start_run(
                command.case, command.duration, command.output_interval, command.device, command.paused
            )
            client.tell(Ack(command.id, {"run": run.run}))
        case PauseRun():
            await registry.pause(command.run)
            client.tell(Ack(command.id))
        case ResumeRun():
            await registry.resume(command.run)
            client.tell(Ack(command.id))
        case StopRun():
            await registry.stop(command.run)
            client.tell(Ack(command.id))
        case GetTerrain():
            await _send_terrain(command, client)
        case Subscribe() | Seek():
            registry.tree.get(command.run)
            client.tell(Ack(command.id))  # a subscription takes effect with its ack
            client.feed.follow_session()
            if isinstance(command, Subscribe):
                client.tell(RunChanged(registry.tree.info(registry.tree.get(command.run))))
                client.tell(registry.edits_changed(command.run))
        case Unsubscribe():
            client.tell(Ack(command.id))
            client.feed.follow_session()
        case AppendEdit():
            revision = await registry.append_edit(command.run, command.edit)
            client.tell(Ack(command.id, {"revision": revision}))
        case UndoEdit():
            client.tell(Ack(command.id, {"revision": await registry.undo_edit(command.run)}))
        case RedoEdit():
            client.tell(Ack(command.id, {"revision": await registry.redo_edit(command.run)}))
        case Recalculate():
            watched = client.feed.run
            child = await registry.recalculate(
                command.run, command.index, command.revision, command.keep_parent
            )
            client.tell(Ack(command.id, {"run": child.run}))
            if watched == command.run:
                client.feed.move_to(child.run, command.index)


async def _send_terrain(command: GetTerrain, client: Client) -> None:
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
