import pytest

from protocol import Credit, InvalidMessage, Message, Seek, Subscribe, limits, pack, unpack_client


def test_a_subscription_replays_from_the_start_with_two_credits_by_default() -> None:
    subscribe = Subscribe(1, "r")
    assert (subscribe.from_index, subscribe.mode, subscribe.credit) == (0, "replay", 2)


@pytest.mark.parametrize(
    "message",
    [
        Credit(0),
        Credit(-1),
        Credit(limits.MAX_CREDIT + 1),
        Subscribe(1, "r", credit=0),
        Subscribe(1, "r", from_index=-1),
        Subscribe(1, "r", mode="sometimes"),  # type: ignore[arg-type]
        Seek(1, "r", -1),
        Seek(1, "r", 2**31),
    ],
)
def test_what_nobody_can_want_is_refused(message: Message) -> None:
    with pytest.raises(InvalidMessage):
        unpack_client(pack(message))
