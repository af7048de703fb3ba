import pytest

from protocol import InvalidMessage, ReleaseControl, TakeControl, pack, unpack_client


def test_control_is_asked_for_politely_and_given_back_to_nobody_by_default() -> None:
    assert TakeControl(1, "r").force is False
    assert ReleaseControl(1, "r").to is None


@pytest.mark.parametrize("message", [TakeControl(1, "../r"), ReleaseControl(1, "r", "no such/id")])
def test_ids_that_are_none_are_refused(message: TakeControl | ReleaseControl) -> None:
    with pytest.raises(InvalidMessage):
        unpack_client(pack(message))
