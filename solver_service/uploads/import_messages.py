"""What the import process is told, and what it may say: one JSON object a line, typed, short and few.

Whoever reads takes nothing for granted: a file reader in that process may have been taken over.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from protocol import CaseSummary

MAX_LINE_BYTES = 64 << 10
MAX_LINES = 20_000
MAX_SENTENCE = 1000

Sentence = Annotated[str, Meta(max_length=MAX_SENTENCE)]


class ImportLimits(msgspec.Struct, frozen=True):
    """What the import of one case may take.

    Attributes:
        cells: most cells of its grid.
        unpacked_bytes: most bytes of its files together.
        memory_bytes: most address space of the process.
        time_s: most processor time, and most wall time [s].
        probe_s: wall time for which the solver is tried [s].
    """

    cells: int = 20_000_000
    unpacked_bytes: int = 4 << 30
    memory_bytes: int = 8 << 30
    time_s: float = 600.0
    probe_s: float = 2.0


class Stage(msgspec.Struct, tag="stage", frozen=True, forbid_unknown_fields=True):
    """How far the import is.

    Attributes:
        stage: what it does.
        done: share of that [0 to 1].
    """

    stage: Literal["unpacking", "reading", "trying"]
    done: Annotated[float, Meta(ge=0.0, le=1.0)] = 0.0


class Accepted(msgspec.Struct, tag="accepted", frozen=True, forbid_unknown_fields=True):
    """The case can be run.

    Attributes:
        summary: the case in a few words.
        warnings: what is odd, one sentence each.
    """

    summary: CaseSummary
    warnings: Annotated[tuple[Sentence, ...], Meta(max_length=50)] = ()


class Refused(msgspec.Struct, tag="refused", frozen=True, forbid_unknown_fields=True):
    """The case cannot be run.

    Attributes:
        sentence: why: file, key, value and what is allowed.
    """

    sentence: Sentence


ImportMessage = Stage | Accepted | Refused

_decoder: msgspec.json.Decoder[ImportMessage] = msgspec.json.Decoder(ImportMessage)


def pack_line(message: ImportMessage) -> bytes:
    """A message as one line."""
    return msgspec.json.encode(message) + b"\n"


def unpack_line(line: bytes) -> ImportMessage:
    """The message of a line.

    Raises:
        msgspec.ValidationError: it is none.
        msgspec.DecodeError: it is no JSON.
    """
    return _decoder.decode(line)
