"""Every message, by direction. A message is a frozen `msgspec.Struct`; its `op` is its name in snake case."""

from __future__ import annotations

from protocol.fields import Command, Message, WireStruct
from protocol.messages.cases import CaseList, CaseSummary, ListCases
from protocol.messages.channels import Channel, ChannelName, ChannelPart, GetChannel
from protocol.messages.control import (
    ControlChanged,
    ControlRequested,
    ReleaseControl,
    TakeControl,
)
from protocol.messages.edits import (
    AppendEdit,
    AppendEdits,
    DeleteEdit,
    EditsChanged,
    RedoEdit,
    ReplaceEdit,
    UndoEdit,
)
from protocol.messages.flow import Credit, Seek, Subscribe, SubscriptionMode, Unsubscribe
from protocol.messages.forcing import ChangeForcing, ForcingChanged
from protocol.messages.frames import Frame, FramePart
from protocol.messages.handshake import Hello, ResumePoint, Welcome, WireLimits
from protocol.messages.imagery import GetImagery, ImageryPart, Layer
from protocol.messages.places import GaugePlace, Places, SectionPlace
from protocol.messages.presenting import PresentView, View, ViewPresented
from protocol.messages.runs import (
    DeleteRun,
    GridInfo,
    LineageEntry,
    ListRuns,
    PauseRun,
    PinRun,
    Recalculate,
    RenameRun,
    ResumeRun,
    RunBranched,
    RunChanged,
    RunInfo,
    RunList,
    RunRemoved,
    RunStatus,
    StartRun,
    StopRun,
    UnpinRun,
)
from protocol.messages.series import GetSeries, Series
from protocol.messages.status import Ack, Error, Notice, Progress, WaterBudget
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
    | GetImagery
    | GetChannel
    | GetSeries
    | Subscribe
    | Unsubscribe
    | Seek
    | Credit
    | AppendEdit
    | AppendEdits
    | ReplaceEdit
    | DeleteEdit
    | UndoEdit
    | RedoEdit
    | ChangeForcing
    | Recalculate
    | RenameRun
    | PinRun
    | UnpinRun
    | DeleteRun
    | TakeControl
    | ReleaseControl
    | PresentView
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
    | ChannelPart
    | ImageryPart
    | EditsChanged
    | ForcingChanged
    | Places
    | Frame
    | FramePart
    | Progress
    | Notice
    | RunRemoved
    | ControlChanged
    | ControlRequested
    | WaterBudget
    | ViewPresented
)

__all__ = [
    "Ack",
    "AppendEdit",
    "AppendEdits",
    "CaseList",
    "CaseSummary",
    "ChangeForcing",
    "Channel",
    "ChannelName",
    "ChannelPart",
    "ClientMessage",
    "Command",
    "ControlChanged",
    "ControlRequested",
    "Credit",
    "DeleteEdit",
    "DeleteRun",
    "EditsChanged",
    "Error",
    "ForcingChanged",
    "Frame",
    "FramePart",
    "GaugePlace",
    "GetChannel",
    "GetImagery",
    "GetSeries",
    "GetTerrain",
    "GridInfo",
    "Hello",
    "ImageryPart",
    "Layer",
    "LineageEntry",
    "ListCases",
    "ListRuns",
    "Message",
    "Notice",
    "PauseRun",
    "PinRun",
    "Places",
    "PresentView",
    "Progress",
    "Recalculate",
    "RedoEdit",
    "ReleaseControl",
    "RenameRun",
    "ReplaceEdit",
    "ResumePoint",
    "ResumeRun",
    "RunBranched",
    "RunChanged",
    "RunInfo",
    "RunList",
    "RunRemoved",
    "RunStatus",
    "SectionPlace",
    "Seek",
    "Series",
    "ServerMessage",
    "StartRun",
    "StopRun",
    "Subscribe",
    "SubscriptionMode",
    "TakeControl",
    "Terrain",
    "UndoEdit",
    "UnpinRun",
    "Unsubscribe",
    "View",
    "ViewPresented",
    "WaterBudget",
    "Welcome",
    "WireLimits",
    "WireStruct",
]
