"""Every message, by direction. A message is a frozen `msgspec.Struct`; its `op` is its name in snake case."""

from __future__ import annotations

from protocol.fields import Command, Message, WireStruct
from protocol.messages.cases import CaseList, CaseSummary, ListCases
from protocol.messages.edits import AppendEdit, EditsChanged, RedoEdit, UndoEdit
from protocol.messages.flow import Credit, Seek, Subscribe, SubscriptionMode, Unsubscribe
from protocol.messages.frames import Frame, FramePart
from protocol.messages.handshake import Hello, ResumePoint, Welcome, WireLimits
from protocol.messages.runs import (
    GridInfo,
    LineageEntry,
    ListRuns,
    PauseRun,
    Recalculate,
    ResumeRun,
    RunBranched,
    RunChanged,
    RunInfo,
    RunList,
    RunStatus,
    StartRun,
    StopRun,
)
from protocol.messages.status import Ack, Error, Notice, Progress
from protocol.messages.terrain import GetTerrain, Terrain

ClientMessage = (
    Hello
    | ListCases
    | ListRuns
    | StartRun
    | PauseRun
    | ResumeRun
    | StopRun
    | GetTerrain
    | Subscribe
    | Unsubscribe
    | Seek
    | Credit
    | AppendEdit
    | UndoEdit
    | RedoEdit
    | Recalculate
)

ServerMessage = (
    Welcome
    | Ack
    | Error
    | CaseList
    | RunList
    | RunChanged
    | RunBranched
    | Terrain
    | EditsChanged
    | Frame
    | FramePart
    | Progress
    | Notice
)

__all__ = [
    "Ack",
    "AppendEdit",
    "CaseList",
    "CaseSummary",
    "ClientMessage",
    "Command",
    "Credit",
    "EditsChanged",
    "Error",
    "Frame",
    "FramePart",
    "GetTerrain",
    "GridInfo",
    "Hello",
    "LineageEntry",
    "ListCases",
    "ListRuns",
    "Message",
    "Notice",
    "PauseRun",
    "Progress",
    "Recalculate",
    "RedoEdit",
    "ResumePoint",
    "ResumeRun",
    "RunBranched",
    "RunChanged",
    "RunInfo",
    "RunList",
    "RunStatus",
    "Seek",
    "ServerMessage",
    "StartRun",
    "StopRun",
    "Subscribe",
    "SubscriptionMode",
    "Terrain",
    "UndoEdit",
    "Unsubscribe",
    "Welcome",
    "WireLimits",
    "WireStruct",
]
