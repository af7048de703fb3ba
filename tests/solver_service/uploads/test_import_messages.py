import msgspec
import pytest

from protocol import CaseSummary
from solver_service.uploads.import_messages import (
    MAX_LINE_BYTES,
    Accepted,
    ImportMessage,
    Refused,
    Stage,
    pack_line,
    unpack_line,
)

SUMMARY = CaseSummary("river", "A river", False, 10, 20, 5.0, 100.0, 10.0)


@pytest.mark.parametrize(
    "message", [Stage("unpacking", 0.5), Accepted(SUMMARY, ("odd",) * 50), Refused("It is not a case.")]
)
def test_a_message_comes_back_as_it_was_and_fits_its_line(message: ImportMessage) -> None:
    line = pack_line(message)
    assert unpack_line(line) == message
    assert line.count(b"\n") == 1
    assert len(line) < MAX_LINE_BYTES


@pytest.mark.parametrize(
    "line",
    [
        b"",
        b"hello",
        b"{}",
        b'{"type":"stage","stage":"dancing"}',
        b'{"type":"stage","stage":"reading","done":7}',
        b'{"type":"refused","sentence":1}',
        b'{"type":"refused","sentence":"' + b"x" * 1001 + b'"}',
        b'{"type":"refused","sentence":"no","run":"/bin/sh"}',
        pack_line(Accepted(SUMMARY)).replace(b'"nrows":10', b'"nrows":100000000'),
        pack_line(Accepted(SUMMARY)).replace(b'"dx":5.0', b'"dx":-5.0'),
        b"[" * 100_000,
    ],
)
def test_a_line_that_is_no_message_is_refused(line: bytes) -> None:
    with pytest.raises((msgspec.MsgspecError, RecursionError)):
        unpack_line(line)
