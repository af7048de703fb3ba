"""What a client wants to see and how much it can still take."""

from __future__ import annotations

from typing import Literal

from protocol.fields import Command, CreditCount, FrameIndex, Identifier, Message
from protocol.limits import DEFAULT_CREDIT

SubscriptionMode = Literal["live", "replay"]


class Subscribe(Command, frozen=True):
    """Begin to receive the frames of a run; replaces an earlier subscription.

    Attributes:
        run: id of the run.
        from_index: first frame index wanted.
        mode: "replay" sends every frame in order; "live" skips to the newest frame whenever credit is there.
        credit: frames that may be sent before the first `credit`.
    """

    run: Identifier
    from_index: FrameIndex = 0
    mode: SubscriptionMode = "replay"
    credit: CreditCount = DEFAULT_CREDIT


class Unsubscribe(Command, frozen=True):
    """Receive no more frames; the credit left is void."""


class Seek(Command, frozen=True):
    """Go on from another frame in replay order.

    Attributes:
        run: id of the subscribed run.
        index: next frame index wanted.
    """

    run: Identifier
    index: FrameIndex


class Credit(Message, frozen=True):
    """Grant more frames: one for each frame received and used. Has no id and no answer.

    Attributes:
        frames: frames that may be sent on top of what was granted before.
    """

    frames: CreditCount = 1
