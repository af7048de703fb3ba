"""The socket and what waits between it and the picture; knows no OpenGL and no GUI."""

from viewer.net.channel_loader import ChannelFields, ChannelKey, ChannelLoader
from viewer.net.connection_thread import ConnectionState, ConnectionThread, NotConnected
from viewer.net.frame_loader import DecodedWater, FrameKey, FrameLoader
from viewer.net.mailbox import Mailbox, MailboxFull
from viewer.net.reconnect import BackOff

__all__ = [
    "BackOff",
    "ChannelFields",
    "ChannelKey",
    "ChannelLoader",
    "ConnectionState",
    "ConnectionThread",
    "DecodedWater",
    "FrameKey",
    "FrameLoader",
    "Mailbox",
    "MailboxFull",
    "NotConnected",
]
