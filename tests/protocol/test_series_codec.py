"""Series of gauges and sections: what is packed comes back, pieces join, and what cannot be is refused."""

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import (
    DecodedSeries,
    FrameError,
    ProtocolError,
    Series,
    decode_series,
    encode_series,
    join_series,
    pack,
    unpack_channel,
)
from tests.protocol.golden import read_hex


def records(first: int, count: int, gauges: int = 2, sections: int = 1) -> DecodedSeries:
    rng = np.random.default_rng(first)
    return DecodedSeries(
        run="r",
        index=first,
        times=0.5 * np.arange(first, first + count),
        gauges=tuple(f"g{k}" for k in range(gauges)),
        gauge_values=rng.random((count, gauges, 4)).astype(np.float32),
        sections=tuple(f"s{k}" for k in range(sections)),
        section_values=rng.random((count, sections, 3)),
    )


def assert_same(found: DecodedSeries, expected: DecodedSeries) -> None:
    assert (found.run, found.index) == (expected.run, expected.index)
    assert (found.gauges, found.sections) == (expected.gauges, expected.sections)
    for name in ("times", "gauge_values", "section_values"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))


@pytest.mark.parametrize(("gauges", "sections"), [(2, 1), (0, 3), (3, 0), (0, 0)])
@pytest.mark.parametrize("count", [0, 1, 7])
def test_records_come_back_bit_for_bit(count: int, gauges: int, sections: int) -> None:
    series = records(5, count, gauges, sections)
    packed = unpack_channel(pack(encode_series(series)))
    assert isinstance(packed, Series)
    assert_same(decode_series(packed), series)


def test_pieces_join_to_what_was_recorded_in_one() -> None:
    whole = records(0, 9)
    cuts = [(0, 1), (1, 1), (1, 6), (6, 9)]
    pieces = [
        encode_series(
            DecodedSeries(
                "r",
                end,
                whole.times[begin:end],
                whole.gauges,
                whole.gauge_values[begin:end],
                whole.sections,
                whole.section_values[begin:end],
            )
        )
        for begin, end in cuts
    ]
    joined = decode_series(join_series(pieces))
    assert joined.index == 9
    np.testing.assert_array_equal(joined.times, whole.times)
    np.testing.assert_array_equal(joined.gauge_values, whole.gauge_values)
    np.testing.assert_array_equal(joined.section_values, whole.section_values)


def test_pieces_of_other_places_do_not_join() -> None:
    with pytest.raises(FrameError, match="different places"):
        join_series([encode_series(records(0, 1)), encode_series(records(1, 1, gauges=3))])


@pytest.mark.parametrize(
    "change",
    [
        {"times": bytes(8)},
        {"times": bytes(24)},
        {"times": b"\0" * 23},
        {"gauge_values": b""},
        {"gauges": ("a",)},
        {"sections": ("a", "b")},
        {"section_values": bytes(3 * 24 + 8)},
        {"section_values": np.full(9, np.nan).tobytes()},
        {"gauge_values": np.full(24, np.inf, np.float32).tobytes()},
    ],
    ids=lambda change: f"{next(iter(change))}-{len(next(iter(change.values())))}",
)
def test_series_whose_sizes_or_numbers_cannot_be_are_refused(change: dict[str, object]) -> None:
    with pytest.raises(FrameError):
        decode_series(msgspec.structs.replace(encode_series(records(0, 3)), **change))


@given(st.data())
def test_damaged_bytes_are_refused_or_harmless(data: st.DataObject) -> None:
    damaged = bytearray(pack(encode_series(records(0, 4))))
    for _ in range(data.draw(st.integers(1, 4))):
        damaged[data.draw(st.integers(0, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    try:
        packed = unpack_channel(bytes(damaged))
        series = decode_series(packed) if isinstance(packed, Series) else None
    except ProtocolError:
        return
    if series is not None:
        assert np.isfinite(series.gauge_values).all()


def test_bytes_of_the_past_decode_for_ever() -> None:
    packed = unpack_channel(read_hex("compressed/stored-series"))
    assert isinstance(packed, Series)
    assert_same(
        decode_series(packed),
        DecodedSeries(
            "r-1",
            3,
            np.array([20.5, 21.0]),
            ("P1", "S6"),
            np.arange(16, dtype=np.float32).reshape(2, 2, 4) / 4,
            ("bridge",),
            np.arange(6, dtype=np.float64).reshape(2, 1, 3) / 3,
        ),
    )
