import math

import msgpack
import pytest

from protocol import Ack, Error, InvalidMessage, Message, Notice, pack, unpack_server


@pytest.mark.parametrize("value", [None, True, 3, 2.5, "r-1"])
def test_a_result_holds_plain_values(value: object) -> None:
    message = Ack(1, {"value": value})  # type: ignore[dict-item]
    assert unpack_server(pack(message)) == message


def test_a_result_holds_nothing_else() -> None:
    for value in ([1], {"a": 1}, b"bytes"):
        with pytest.raises(InvalidMessage, match="result"):
            unpack_server(msgpack.packb({"op": "ack", "id": 1, "result": {"value": value}}))
    with pytest.raises(ValueError, match="result"):
        Ack(1, {"value": math.nan})


@pytest.mark.parametrize(
    "message",
    [
        Error(1, "Not A Code", "x"),
        Error(1, "", "x"),
        Error(1, "code\n", "x"),
        Error(1, "code", "x" * 2001),
        Error(0, "code", "x"),
        Notice("shout", "x"),  # type: ignore[arg-type]
        Notice("info", "x", "not a run"),
    ],
)
def test_an_answer_that_cannot_be_is_refused(message: Message) -> None:
    with pytest.raises(InvalidMessage):
        unpack_server(pack(message))
