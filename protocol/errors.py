"""Everything that can go wrong on the wire.

```
ProtocolError
 +- MalformedMessage     malformed             the bytes are not one msgpack map
 +- TooLarge             too_large             a limit of `protocol.limits` is passed
 +- UnknownMessage       unknown_message       no such operation in this direction
 +- InvalidMessage       invalid_message       a field is missing, of the wrong type or out of range
 +- SequenceError        out_of_sequence       a valid message at the wrong moment
 +- VersionMismatch      unsupported_version   no protocol version in common
 +- Overloaded           overloaded            more unanswered commands than a peer may have
 +- GridError            invalid_grid          a grid geometry that cannot be
 +- EditError            invalid_edit          an edit that cannot be applied to this terrain
 +- ForcingError         invalid_forcing       a change of forcing that the case has no place for
 +- FrameError           corrupt_frame         a frame or terrain that does not decode
     +- MissingKeyFrame  missing_key_frame     a delta whose key frame is not at hand
```

A fatal error leaves the connection out of step: the service sends `error` and closes with `close_code`. Any
other is answered by an `error` with the command's id, and the connection goes on.
"""

from __future__ import annotations

from typing import ClassVar


class ProtocolError(Exception):
    """Base of all errors of this package; its text is one sentence for a person.

    Attributes:
        code: stable name sent in the `error` message.
        close_code: websocket close code to use if the connection is closed because of it.
        fatal: whether the connection cannot go on.
        message_id: id of the command that caused it, when it could be read.
    """

    code: ClassVar[str] = "protocol_error"
    close_code: ClassVar[int] = 1002
    fatal: ClassVar[bool] = True

    def __init__(self, text: str, *, message_id: int | None = None) -> None:
        super().__init__(text)
        self.message_id = message_id


class MalformedMessage(ProtocolError):
    """The bytes are not one msgpack map with string keys."""

    code = "malformed"
    close_code = 1007


class TooLarge(ProtocolError):
    """A message, array, string or payload is larger than the limits allow."""

    code = "too_large"
    close_code = 1009


class UnknownMessage(ProtocolError):
    """The operation does not exist in this direction."""

    code = "unknown_message"
    close_code = 1008
    fatal = False


class InvalidMessage(ProtocolError):
    """A field is missing, of the wrong type or out of range."""

    code = "invalid_message"
    close_code = 1008
    fatal = False


class SequenceError(ProtocolError):
    """A valid message came at the wrong moment, or an id was used twice."""

    code = "out_of_sequence"
    close_code = 1002


class VersionMismatch(ProtocolError):
    """The peers have no protocol version in common."""

    code = "unsupported_version"
    close_code = 1002


class Overloaded(ProtocolError):
    """A peer has more unanswered commands than it may have."""

    code = "overloaded"
    close_code = 1013


class GridError(ProtocolError):
    """A grid geometry that cannot be: no cells, no positive cell size, a number that is not finite."""

    code = "invalid_grid"
    close_code = 1008
    fatal = False


class EditError(ProtocolError):
    """An edit that cannot be applied to this terrain."""

    code = "invalid_edit"
    close_code = 1008
    fatal = False


class ForcingError(ProtocolError):
    """A change of forcing that the case has no place for, or that brings values beyond what is allowed."""

    code = "invalid_forcing"
    close_code = 1008
    fatal = False


class FrameError(ProtocolError):
    """A frame or a terrain that does not decode to what it declares."""

    code = "corrupt_frame"
    close_code = 1007


class MissingKeyFrame(FrameError):
    """A delta frame whose key frame is not at hand.

    Attributes:
        run: run of the missing key frame.
        index: frame index of the missing key frame.
    """

    code = "missing_key_frame"
    fatal = False

    def __init__(self, run: str, index: int) -> None:
        super().__init__(f"The key frame {index} of run {run!r} is needed first.")
        self.run = run
        self.index = index
