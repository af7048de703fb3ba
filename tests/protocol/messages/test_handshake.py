import msgspec
import pytest

from protocol import Hello, InvalidMessage, ResumePoint, Welcome, WireLimits, limits, pack, unpack_client


def test_a_token_is_never_shown() -> None:
    hello = Hello(token="t0p-secret")
    assert "t0p-secret" not in repr(hello)
    assert "t0p-secret" not in f"{hello} {[hello]}"
    assert "token=None" in repr(Hello())


def test_nothing_seen_yet_is_index_minus_1() -> None:
    point = ResumePoint("r", -1, 0)
    assert unpack_client(pack(Hello(resume=point))) == Hello(resume=point)
    with pytest.raises(InvalidMessage, match="last_index"):
        unpack_client(pack(Hello(resume=ResumePoint("r", -2, 0))))


def test_a_long_token_or_client_name_is_refused() -> None:
    for hello in (Hello(token="x" * 513), Hello(client="x" * 257), Hello(versions=("v",) * 65)):
        with pytest.raises(InvalidMessage):
            unpack_client(pack(hello))


def test_the_limits_told_are_those_enforced() -> None:
    told = msgspec.structs.asdict(WireLimits())
    assert told == {name: getattr(limits, name.upper()) for name in told}


def test_a_welcome_tells_the_limits_by_itself() -> None:
    assert Welcome("fev.v1", "s", "0", "id").limits == WireLimits()
