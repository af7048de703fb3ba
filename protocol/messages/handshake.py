"""The first message of each side: who speaks, which version, which limits."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol import limits
from protocol.fields import Count, Identifier, Message, Name, Revision, WireStruct
from protocol.version import CAPABILITIES, PROTOCOL_VERSION, SUPPORTED_VERSIONS

Names = Annotated[tuple[Name, ...], Meta(max_length=64)]


class ResumePoint(WireStruct, frozen=True):
    """What a client that lost its connection last knew.

    Attributes:
        run: the run it watched.
        last_index: last frame index it received, or -1.
        revision: revision of the edit list it knew.
        session: id of the connection that was lost; the control of its runs passes to the new one.
    """

    run: Identifier
    last_index: Annotated[int, Meta(ge=-1, le=2**31 - 1)]
    revision: Revision
    session: Identifier | None = None


class Hello(Message, frozen=True):
    """First message of a client. The answer is `welcome`, or `error` and a close.

    Attributes:
        protocol: the version the client prefers.
        versions: every version the client can speak.
        client: name and version of the client program, for logs.
        token: access token, when it was not in the Authorization header.
        resume: what the client last knew; `run_changed`, `edits_changed` and `forcing_changed` of that run
            follow the welcome.
        capabilities: what the client can do; unknown names are ignored.
    """

    protocol: Name = PROTOCOL_VERSION
    versions: Names = SUPPORTED_VERSIONS
    client: Name = ""
    token: Annotated[str, Meta(max_length=512)] | None = None
    resume: ResumePoint | None = None
    capabilities: Names = CAPABILITIES

    def __repr__(self) -> str:
        """All fields but the token, which must not reach a log."""
        token = None if self.token is None else "..."
        return (
            f"Hello(protocol={self.protocol!r}, versions={self.versions!r}, client={self.client!r},"
            f" token={token!r}, resume={self.resume!r}, capabilities={self.capabilities!r})"
        )


class WireLimits(WireStruct, frozen=True):
    """The limits of `protocol.limits` that the service enforces.

    Attributes:
        inbound_max_bytes: largest message the service accepts [bytes].
        outbound_max_bytes: largest message the service sends [bytes].
        part_bytes: largest data of a part [bytes].
        max_vertices: most vertices of one edit.
        max_edits: most edits of a run.
        max_log_vertices: most vertices of all edits of a run.
        max_credit: most frames granted and not yet received.
        max_pending_commands: most commands unanswered.
        key_frames_kept: key frames the service believes the client keeps.
    """

    inbound_max_bytes: Count = limits.INBOUND_MAX_BYTES
    outbound_max_bytes: Count = limits.OUTBOUND_MAX_BYTES
    part_bytes: Count = limits.PART_BYTES
    max_vertices: Count = limits.MAX_VERTICES
    max_edits: Count = limits.MAX_EDITS
    max_log_vertices: Count = limits.MAX_LOG_VERTICES
    max_credit: Count = limits.MAX_CREDIT
    max_pending_commands: Count = limits.MAX_PENDING_COMMANDS
    key_frames_kept: Count = limits.KEY_FRAMES_KEPT


class Welcome(Message, frozen=True):
    """Answer of the service to `hello`: the connection is open.

    Attributes:
        protocol: the version both peers speak from here on.
        server: name of the service program.
        version: version of the service program.
        session: id of this connection, for logs.
        limits: the limits in force.
        capabilities: what the service can do.
        devices: devices a run may ask for, "cpu" or "cuda:N".
    """

    protocol: Name
    server: Name
    version: Name
    session: Identifier
    limits: WireLimits = WireLimits()
    capabilities: Names = CAPABILITIES
    devices: Names = ("cpu",)
