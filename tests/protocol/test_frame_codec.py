"""Frames through the encoder, the wire and the decoder, some of them lost."""

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from protocol import (
    BlockLayout,
    Frame,
    FrameDecoder,
    FrameEncoder,
    FrameError,
    GridGeometry,
    MissingKeyFrame,
    ProtocolError,
    TooLarge,
    depth_error_bound,
    limits,
    peek_frame,
    quantise_depth,
    unpack_frame,
)
from tests.protocol.golden import read_hex

LAYOUT = BlockLayout(70, 101)


def flood(index: int, h_max: float = 5.0) -> np.ndarray:
    """A wave that wets more of the grid with every frame, and dries behind it."""
    row, col = np.mgrid[0 : LAYOUT.nrows, 0 : LAYOUT.ncols].astype(np.float32)
    h = h_max * np.exp(-(((col - 6.0 * index) / 20.0) ** 2)) - 0.05 * row
    return np.maximum(h, 0.0).astype(np.float32)


def encode_run(count: int, group: int = 4) -> list[bytes]:
    encoder = FrameEncoder(LAYOUT, group=group)
    return [encoder.encode("r", k, 10.0 * k, 1, flood(k)) for k in range(count)]


def test_a_frame_comes_back_within_the_error_bound_with_what_it_is_about() -> None:
    frame = unpack_frame(FrameEncoder(LAYOUT).encode("r", 7, 70.0, 3, flood(7)))
    decoded = FrameDecoder(LAYOUT).decode(frame)
    assert (decoded.run, decoded.index, decoded.time, decoded.revision) == ("r", 7, 70.0, 3)
    assert decoded.h.dtype == np.float32
    assert np.abs(decoded.h - flood(7)).max() <= depth_error_bound(decoded.scale, 1e-3) + 1e-6
    np.testing.assert_array_equal(decoded.states, LAYOUT.classify(decoded.q))


def test_a_group_begins_with_a_key_frame_and_leans_on_it() -> None:
    frames = [unpack_frame(data) for data in encode_run(10)]
    assert [frame.key_index for frame in frames] == [0, 0, 0, 0, 4, 4, 4, 4, 8, 8]
    assert [frame.is_key for frame in frames] == [k % 4 == 0 for k in range(10)]


def test_depths_and_quantised_depths_make_the_same_bytes() -> None:
    from_h, from_q = FrameEncoder(LAYOUT), FrameEncoder(LAYOUT)
    for k in range(3):
        q = quantise_depth(flood(k), 0.001, 1e-3)
        data = from_q.encode("r", k, 1.0, 0, (q, LAYOUT.classify(q)), scale=0.001)
        assert from_h.encode("r", k, 1.0, 0, flood(k)) == data


def test_a_grid_may_be_given_for_its_layout() -> None:
    grid = GridGeometry(LAYOUT.nrows, LAYOUT.ncols, 5.0)
    data = FrameEncoder(grid).encode("r", 0, 0.0, 0, flood(3))
    assert FrameDecoder(grid).decode(unpack_frame(data)).q.shape == grid.shape


@given(st.lists(st.booleans(), min_size=24, max_size=24), st.integers(1, 9))
def test_any_frames_but_key_frames_may_be_lost(arrives: list[bool], group: int) -> None:
    decoder = FrameDecoder(LAYOUT)
    for data, comes in zip(encode_run(24, group), arrives, strict=True):
        frame = unpack_frame(data)
        if frame.is_key or comes:
            q = quantise_depth(flood(frame.index), frame.scale, 1e-3)
            np.testing.assert_array_equal(decoder.decode(frame).q, q)


def test_a_delta_without_its_key_frame_names_it_and_decodes_once_it_came() -> None:
    frames = [unpack_frame(data) for data in encode_run(8)]
    decoder = FrameDecoder(LAYOUT)
    decoder.decode(frames[0])
    with pytest.raises(MissingKeyFrame) as caught:
        decoder.decode(frames[6])
    assert (caught.value.run, caught.value.index) == ("r", 4)
    assert not decoder.has_key("r", 4)
    decoder.decode(frames[4])
    assert decoder.has_key("r", 4)
    assert decoder.decode(frames[6]).index == 6


def test_a_key_frame_of_another_run_does_not_serve() -> None:
    frames = [unpack_frame(data) for data in encode_run(2)]
    decoder = FrameDecoder(LAYOUT)
    decoder.decode(msgspec.structs.replace(frames[0], run="other"))
    with pytest.raises(MissingKeyFrame):
        decoder.decode(frames[1])


def test_the_latest_key_frames_received_are_kept() -> None:
    frames = [unpack_frame(data) for data in encode_run(limits.KEY_FRAMES_KEPT + 1, group=1)]
    decoder = FrameDecoder(LAYOUT)
    for frame in [*frames[:-1], frames[0], frames[-1]]:
        decoder.decode(frame)
    assert decoder.has_key("r", 0)
    assert not decoder.has_key("r", 1)


def test_a_forced_key_frame_begins_a_group() -> None:
    encoder = FrameEncoder(LAYOUT, group=4)
    forced = [encoder.encode("r", k, 0.0, 0, flood(k), force_key=k == 2) for k in range(7)]
    assert [unpack_frame(data).key_index for data in forced] == [0, 0, 2, 2, 2, 2, 6]


def test_another_run_and_a_step_back_begin_with_a_key_frame() -> None:
    encoder = FrameEncoder(LAYOUT)
    encoder.encode("r", 5, 0.0, 0, flood(5))
    assert unpack_frame(encoder.encode("child", 6, 0.0, 0, flood(6))).is_key
    assert unpack_frame(encoder.encode("child", 3, 0.0, 0, flood(3))).is_key


def test_water_above_the_range_of_its_group_begins_another_with_a_coarser_scale() -> None:
    encoder = FrameEncoder(LAYOUT)
    decoder = FrameDecoder(LAYOUT)
    depths = [5.0, 60.0, 64.0, 100.0, 5.0]
    frames = [unpack_frame(encoder.encode("r", k, 0.0, 0, flood(k, h))) for k, h in enumerate(depths)]
    assert [frame.scale for frame in frames] == [0.001, 0.001, 0.001, 0.005, 0.005]
    assert [frame.key_index for frame in frames] == [0, 0, 0, 3, 3]
    for k, frame in enumerate(frames):
        error = np.abs(decoder.decode(frame).h - flood(k, depths[k])).max()
        assert error <= depth_error_bound(frame.scale, 1e-3) + 1e-5


def test_a_new_group_may_go_back_to_a_finer_scale() -> None:
    encoder = FrameEncoder(LAYOUT, group=2)
    scales = [
        unpack_frame(encoder.encode("r", k, 0.0, 0, flood(k, h))).scale for k, h in ((0, 100.0), (2, 5.0))
    ]
    assert scales == [0.005, 0.001]


def test_a_dry_grid_makes_an_empty_payload() -> None:
    frame = unpack_frame(FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, np.zeros((70, 101))))
    assert frame.raw_size == 0
    assert not FrameDecoder(LAYOUT).decode(frame).h.any()


def test_blocks_that_dry_within_a_group_are_dry() -> None:
    encoder, decoder = FrameEncoder(LAYOUT), FrameDecoder(LAYOUT)
    decoder.decode(unpack_frame(encoder.encode("r", 0, 0.0, 0, np.ones((70, 101)))))
    decoded = decoder.decode(unpack_frame(encoder.encode("r", 1, 0.0, 0, np.zeros((70, 101)))))
    assert not decoded.q.any()
    assert not decoded.states.any()


def test_the_arrays_given_may_change_afterwards() -> None:
    encoder, decoder = FrameEncoder(LAYOUT), FrameDecoder(LAYOUT)
    q = quantise_depth(flood(2), 0.001, 1e-3)
    states = LAYOUT.classify(q)
    decoder.decode(unpack_frame(encoder.encode("r", 0, 0.0, 0, (q, states))))
    first = q.copy()
    q[:] = 7
    data = encoder.encode("r", 1, 0.0, 0, (first, states))
    np.testing.assert_array_equal(decoder.decode(unpack_frame(data)).q, first)


def test_decoded_frames_do_not_share_memory_with_kept_key_frames() -> None:
    frames = [unpack_frame(data) for data in encode_run(2)]
    decoder = FrameDecoder(LAYOUT)
    key = decoder.decode(frames[0])
    with pytest.raises(ValueError, match="read-only"):
        key.q[0, 0] = 99
    np.testing.assert_array_equal(decoder.decode(frames[1]).q, quantise_depth(flood(1), 0.001, 1e-3))


def test_peeking_tells_what_a_store_wants_to_know() -> None:
    frame = peek_frame(encode_run(2)[1])
    assert (frame.run, frame.index, frame.time, frame.revision, frame.key_index) == ("r", 1, 10.0, 1, 0)


@pytest.mark.parametrize("h", [np.nan, np.inf])
def test_water_that_is_not_finite_is_refused(h: float) -> None:
    water = flood(0)
    water[3, 4] = h
    with pytest.raises(FrameError, match="finite"):
        FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, water)


def test_water_of_another_shape_is_refused() -> None:
    with pytest.raises(FrameError, match="shape"):
        FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, np.zeros((101, 70), dtype=np.float32))
    q = np.zeros((70, 101), dtype=np.uint16)
    with pytest.raises(FrameError, match="shape"):
        FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, (q, np.zeros((1, 1), dtype=np.uint8)))


@pytest.mark.parametrize("group", [0, 33])
def test_a_group_of_an_impossible_length_is_refused(group: int) -> None:
    with pytest.raises(FrameError):
        FrameEncoder(LAYOUT, group=group)


def test_a_changed_bit_of_a_payload_is_noticed_or_harmless(rng: np.random.Generator) -> None:
    frame = unpack_frame(FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, flood(2)))
    whole = FrameDecoder(LAYOUT).decode(frame).q
    for position in rng.integers(0, len(frame.payload), 200):
        payload = bytearray(frame.payload)
        payload[position] ^= 1 << int(rng.integers(0, 8))
        damaged = msgspec.structs.replace(frame, payload=bytes(payload))
        try:
            np.testing.assert_array_equal(FrameDecoder(LAYOUT).decode(damaged).q, whole)
        except ProtocolError:
            continue


@pytest.mark.parametrize(
    "change",
    [
        {"checksum": 0},
        {"raw_size": 2},
        {"states": b""},
        {"states": b"\xff\xff\xff"},
        {"payload": b""},
        {"payload": b"not zstd at all"},
    ],
    ids=lambda change: next(iter(change)),
)
def test_a_frame_that_is_not_what_it_declares_is_refused(change: dict[str, object]) -> None:
    frame = unpack_frame(FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, flood(2)))
    with pytest.raises(FrameError):
        FrameDecoder(LAYOUT).decode(msgspec.structs.replace(frame, **change))


def test_a_raw_size_that_would_swell_memory_is_refused() -> None:
    frame = unpack_frame(FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, flood(2)))
    with pytest.raises((FrameError, TooLarge)):
        FrameDecoder(LAYOUT).decode(msgspec.structs.replace(frame, raw_size=4 * limits.MAX_CELLS))


def test_a_delta_of_another_scale_than_its_key_frame_is_refused() -> None:
    frames = [unpack_frame(data) for data in encode_run(2)]
    decoder = FrameDecoder(LAYOUT)
    decoder.decode(frames[0])
    with pytest.raises(FrameError, match="scale"):
        decoder.decode(msgspec.structs.replace(frames[1], scale=0.002))


def test_frames_encoded_in_the_past_can_still_be_read() -> None:
    # Compressed bytes may differ between releases of zstd, so these are read only.
    decoder = FrameDecoder(BlockLayout(34, 34))
    expected = np.zeros((34, 34), dtype=np.uint16)
    expected[2:5, 3:8] = np.arange(1, 16).reshape(3, 5) * 1000
    for name, change in (("stored-key-frame", 0), ("stored-delta-frame", 7)):
        frame = unpack_frame(read_hex(f"compressed/{name}"))
        assert isinstance(frame, Frame)
        np.testing.assert_array_equal(decoder.decode(frame).q, expected + change * (expected > 0))


def test_frames_in_planes_encoded_in_the_past_can_still_be_read() -> None:
    decoder = FrameDecoder(LAYOUT)
    for index in (0, 1):
        frame = unpack_frame(read_hex(f"compressed/stored-planes-{index}"))
        assert (frame.codec, frame.key_index) == ("planes", 0)
        np.testing.assert_array_equal(decoder.decode(frame).q, quantise_depth(flood(index), 0.001, 1e-3))


def test_a_frame_in_planes_is_refused_by_whoever_takes_it_for_plain_numbers() -> None:
    frame = unpack_frame(FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, flood(3)))
    with pytest.raises(FrameError, match="checksum"):
        FrameDecoder(LAYOUT).decode(msgspec.structs.replace(frame, codec="u2"))


def test_a_lowered_bed_comes_with_every_frame_and_a_frame_without_one_has_the_bytes_it_had() -> None:
    bed = np.array([3, 700], np.int64), np.array([-1.5, 2.25], np.float32)
    encoder, decoder = FrameEncoder(LAYOUT), FrameDecoder(LAYOUT)
    for index in range(2):
        data = encoder.encode("r", index, 0.0, 0, flood(index), scale=0.001, bed=bed)
        decoded = decoder.decode(unpack_frame(data))
        np.testing.assert_array_equal(decoded.bed_cells, bed[0])
        np.testing.assert_array_equal(decoded.bed_values, bed[1])
    none = np.zeros(0, np.int64), np.zeros(0, np.float32)
    plain = FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, flood(0))
    assert FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, flood(0), bed=none) == plain
    assert b"bed_cells" not in plain


def test_a_lowered_bed_that_was_changed_on_the_way_is_refused() -> None:
    bed = np.array([3, 700], np.int64), np.array([-1.5, 2.25], np.float32)
    frame = unpack_frame(FrameEncoder(LAYOUT).encode("r", 0, 0.0, 0, flood(0), bed=bed))
    for field in ("bed_cells", "bed_values"):
        changed = bytearray(getattr(frame, field))
        changed[0] ^= 1
        with pytest.raises(FrameError, match="checksum"):
            FrameDecoder(LAYOUT).decode(msgspec.structs.replace(frame, **{field: bytes(changed)}))
