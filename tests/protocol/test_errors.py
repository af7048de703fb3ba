from collections.abc import Iterator

import protocol.errors
from protocol import MissingKeyFrame, ProtocolError


def tree(kind: type[ProtocolError]) -> Iterator[type[ProtocolError]]:
    for child in kind.__subclasses__():
        yield child
        yield from tree(child)


def test_every_error_is_drawn_in_the_tree_with_its_code() -> None:
    drawing = protocol.errors.__doc__ or ""
    lines = [line.split() for line in drawing.splitlines()]
    for kind in tree(ProtocolError):
        assert any(kind.__name__ in line and kind.code in line for line in lines), kind


def test_codes_are_unique() -> None:
    codes = [kind.code for kind in tree(ProtocolError)]
    assert len(set(codes)) == len(codes)


def test_close_codes_are_those_of_websockets() -> None:
    assert {kind.close_code for kind in tree(ProtocolError)} <= {1002, 1007, 1008, 1009, 1013}


def test_an_error_carries_the_id_of_its_command() -> None:
    assert ProtocolError("No.", message_id=4).message_id == 4
    assert ProtocolError("No.").message_id is None


def test_a_missing_key_frame_says_which() -> None:
    error = MissingKeyFrame("r-1", 64)
    assert (error.run, error.index) == ("r-1", 64)
    assert "64" in str(error)
    assert "r-1" in str(error)
