"""The union of all commands: what `viewer.app` can carry out."""

from __future__ import annotations

from viewer.commands.camera import CameraCommand
from viewer.commands.edits import EditCommand
from viewer.commands.forcing import ForcingCommand
from viewer.commands.measuring import MeasuringCommand
from viewer.commands.picture import PictureCommand
from viewer.commands.playback import PlaybackCommand
from viewer.commands.presenting import PresentingCommand
from viewer.commands.runs import RunCommand
from viewer.errors import ViewerError

__all__ = ["Command", "CommandError"]


class CommandError(ViewerError):
    """A command that cannot be made or carried out; the text says why in one sentence."""


Command = (
    PlaybackCommand
    | MeasuringCommand
    | PresentingCommand
    | RunCommand
    | ForcingCommand
    | EditCommand
    | CameraCommand
    | PictureCommand
)
"""Any command."""
