"""Channels through the encoder, the wire and the decoder; damaged and hostile ones."""

import tracemalloc
import zlib
from collections.abc import Mapping

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import (
    BlockLayout,
    Channel,
    ChannelName,
    FrameError,
    ProtocolError,
    TooLarge,
    decode_channel,
    encode_channel,
    limits,
    pack,
    unpack_channel,
)
from protocol.channel_codec import CHANNEL_FIELDS, FINEST, LEVELS, choose_scale
from protocol.compression import compress
from tests.protocol.golden import read_hex

LAYOUT = BlockLayout(70, 101)
ROW, COL = np.mgrid[0:70, 0:101].astype(np.float32)
WET = (COL > 40) & (ROW < 50)
STATES = LAYOUT.classify(WET.astype(np.uint16))


def wet_only(values: np.ndarray) -> np.ndarray:
    return np.where(WET, values, 0.0).astype(np.float32)


FIELDS: Mapping[ChannelName, Mapping[str, np.ndarray]] = {
    "velocity": {"u": wet_only(3.7 * np.sin(COL / 9.0)), "v": wet_only(-0.4 * np.cos(ROW / 7.0))},
    "maxima": {
        "max_depth": wet_only(5.0 + np.sin(COL)),
        "max_speed": wet_only(12.0 * np.abs(np.sin(ROW))),
        "max_hazard": wet_only(80.0 * np.abs(np.cos(ROW * COL))),
        "arrival_time": np.where(WET & (ROW > 3), 40.3 * ROW + 0.7 * COL, np.inf).astype(np.float32),
    },
}


def packed(channel: ChannelName) -> Channel:
    return unpack_channel(encode_channel(LAYOUT, "r", 7, 70.0, channel, FIELDS[channel], STATES))


@pytest.mark.parametrize("channel", CHANNEL_FIELDS)
def test_a_channel_comes_back_within_its_error_bounds_with_what_it_is_about(channel: ChannelName) -> None:
    decoded = decode_channel(LAYOUT, packed(channel))
    assert (decoded.run, decoded.index, decoded.time, decoded.channel) == ("r", 7, 70.0, channel)
    assert tuple(decoded.fields) == CHANNEL_FIELDS[channel]
    for name, values in FIELDS[channel].items():
        field, bound = decoded.fields[name], decoded.error_bounds[name]
        assert field.dtype == np.float32
        known = np.isfinite(values)
        np.testing.assert_array_equal(known, np.isfinite(field))
        error = np.abs(field[known] - values[known]).max()
        assert error <= bound * 1.01
        assert bound <= np.abs(values[known]).max() / 3276.0
        assert error > 0.5 * bound, "the bound is not idle"


def test_a_cell_that_was_never_reached_has_no_arrival_and_no_maxima() -> None:
    fields = decode_channel(LAYOUT, packed("maxima")).fields
    assert np.isinf(fields["arrival_time"][~WET]).all()
    assert not fields["max_depth"][~WET].any()


def test_cells_of_dry_blocks_take_no_room() -> None:
    count = LAYOUT.owned_count(STATES)
    assert count < LAYOUT.nrows * LAYOUT.ncols
    assert packed("velocity").raw_size == 4 * count
    assert packed("maxima").raw_size == 8 * count


def test_a_dry_grid_is_a_channel_without_cells() -> None:
    nothing = {name: np.zeros((70, 101), np.float32) for name in ("u", "v")}
    data = encode_channel(
        LAYOUT, "r", 0, 0.0, "velocity", nothing, LAYOUT.classify(np.zeros((70, 101), np.uint16))
    )
    assert unpack_channel(data).raw_size == 0
    assert not decode_channel(LAYOUT, unpack_channel(data)).fields["u"].any()


@given(st.floats(1e-9, 1e6))
def test_a_scale_is_one_two_or_five_and_spends_the_levels(largest: float) -> None:
    scale = choose_scale(largest)
    digit = float(f"{scale:e}".partition("e")[0])
    assert digit in (1.0, 2.0, 5.0)
    assert largest / scale <= LEVELS * (1 + 1e-12)
    assert scale == FINEST or largest / scale > LEVELS / 2.51


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_velocity_that_is_not_finite_is_not_packed(value: float) -> None:
    u = FIELDS["velocity"]["u"].copy()
    u[3, 50] = value
    with pytest.raises(FrameError):
        encode_channel(LAYOUT, "r", 0, 0.0, "velocity", {"u": u, "v": u}, STATES)


@pytest.mark.parametrize("value", [np.nan, -1.0, -np.inf])
def test_an_arrival_before_the_start_is_not_packed(value: float) -> None:
    arrival = FIELDS["maxima"]["arrival_time"].copy()
    arrival[3, 50] = value
    with pytest.raises(FrameError, match="arrival_time"):
        encode_channel(LAYOUT, "r", 0, 0.0, "maxima", {**FIELDS["maxima"], "arrival_time": arrival}, STATES)


def test_a_field_of_another_shape_is_not_packed() -> None:
    u = np.zeros((70, 100), np.float32)
    with pytest.raises(FrameError, match=r"\(70, 100\)"):
        encode_channel(LAYOUT, "r", 0, 0.0, "velocity", {"u": u, "v": u}, STATES)


@pytest.mark.parametrize(
    "change",
    [
        {"raw_size": 0},
        {"raw_size": packed("maxima").raw_size - 2},
        {"raw_size": 2**29},
        {"checksum": 1},
        {"states": b""},
        {"states": b"\xff" * LAYOUT.packed_size},
        {"scales": (0.1,) * 3},
        {"channel": "velocity"},
        {"payload": b""},
        {"payload": compress(b"\0" * 16)},
    ],
    ids=str,
)
def test_a_channel_that_does_not_hold_what_it_declares_is_refused(change: dict[str, object]) -> None:
    with pytest.raises(FrameError):
        decode_channel(LAYOUT, msgspec.structs.replace(packed("maxima"), **change))


def test_a_bomb_is_refused_before_memory_is_taken() -> None:
    channel = packed("velocity")
    bomb = compress(bytes(1 << 26))
    tracemalloc.start()
    try:
        with pytest.raises(FrameError):
            decode_channel(LAYOUT, msgspec.structs.replace(channel, payload=bomb))
        with pytest.raises(ProtocolError):
            unpack_channel(pack(msgspec.structs.replace(channel, raw_size=limits.MAX_CHANNEL_BYTES + 1)))
        assert tracemalloc.get_traced_memory()[1] < 4 << 20
    finally:
        tracemalloc.stop()


def test_a_packed_channel_larger_than_the_limit_is_refused_unread(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("protocol.codec.MAX_CHANNEL_BYTES", 100)
    with pytest.raises(TooLarge):
        packed("velocity")


@given(st.data())
def test_damaged_bytes_are_refused_or_decode_to_finite_numbers(data: st.DataObject) -> None:
    channel = data.draw(st.sampled_from(sorted(CHANNEL_FIELDS)))
    damaged = bytearray(encode_channel(LAYOUT, "r", 7, 70.0, channel, FIELDS[channel], STATES))
    for _ in range(data.draw(st.integers(1, 4))):
        damaged[data.draw(st.integers(0, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    try:
        decoded = decode_channel(LAYOUT, unpack_channel(bytes(damaged)))
    except ProtocolError:
        return
    for field in decoded.fields.values():
        assert field.shape == (70, 101)
        assert not np.isnan(field).any()


@pytest.mark.parametrize("channel", CHANNEL_FIELDS)
def test_stored_bytes_decode_for_ever(channel: ChannelName) -> None:
    stored = unpack_channel(read_hex(f"compressed/stored-channel-{channel}"))
    decoded = decode_channel(LAYOUT, stored)
    assert (
        zlib.crc32(b"".join(decoded.fields[name].tobytes() for name in CHANNEL_FIELDS[channel]))
        == {
            "velocity": 0xABD8B7CE,
            "maxima": 0xB02C99F8,
        }[channel]
    )
    for name, values in FIELDS[channel].items():
        known = np.isfinite(values)
        np.testing.assert_allclose(
            decoded.fields[name][known], values[known], rtol=0, atol=1.01 * decoded.error_bounds[name]
        )
