"""Packed frames in, depth arrays out, on a thread of its own."""

from collections.abc import Iterator

import msgspec
import numpy as np
import pytest

import protocol
from tests.viewer.tiny_service import wait_for
from viewer.net import FrameLoader

NROWS, NCOLS, COUNT = 40, 70, 40
GRID = protocol.GridGeometry(NROWS, NCOLS, 5.0)


def depth(index: int) -> np.ndarray:
    h = np.zeros((NROWS, NCOLS), dtype=np.float32)
    h[5:20, : 10 + index] = 1.0 + 0.01 * index
    return h


@pytest.fixture(scope="module")
def frames() -> list[protocol.Frame]:
    encoder = protocol.FrameEncoder(GRID, group=8)
    return [protocol.unpack_frame(encoder.encode("run", k, 10.0 * k, 0, depth(k))) for k in range(COUNT)]


@pytest.fixture
def loader() -> Iterator[FrameLoader]:
    made = FrameLoader()
    made.add_run("run", NROWS, NCOLS)
    yield made
    made.close()


def test_a_delta_frame_is_decoded_through_its_key(loader: FrameLoader, frames: list[protocol.Frame]) -> None:
    for frame in frames:
        loader.store(frame)
    assert not frames[13].is_key
    assert loader.wait([("run", 13)], 5.0)
    water = loader.get(("run", 13))

    assert water is not None
    assert (water.index, water.time) == (13, 130.0)
    np.testing.assert_allclose(water.h, depth(13), atol=frames[13].scale)


def test_frames_can_be_had_in_any_order(loader: FrameLoader, frames: list[protocol.Frame]) -> None:
    for frame in frames:
        loader.store(frame)
    for index in (39, 2, 25, 0, 17):
        assert loader.wait([("run", index)], 5.0)
        water = loader.get(("run", index))
        assert water is not None
        np.testing.assert_allclose(water.h, depth(index), atol=frames[index].scale)


def test_what_is_not_at_hand_is_named_for_fetching(loader: FrameLoader, frames: list[protocol.Frame]) -> None:
    assert loader.missing_for(("run", 13)) == 13
    loader.store(frames[13])
    assert loader.missing_for(("run", 13)) == 8
    loader.store(frames[8])

    assert loader.missing_for(("run", 13)) is None


def test_a_wanted_frame_is_decoded_as_soon_as_its_key_comes(
    loader: FrameLoader, frames: list[protocol.Frame]
) -> None:
    loader.store(frames[13])
    loader.want([("run", 13)])
    assert loader.get(("run", 13)) is None
    loader.store(frames[8])

    wait_for(lambda: loader.get(("run", 13)) is not None)


def test_a_damaged_frame_is_told_and_others_go_on(loader: FrameLoader, frames: list[protocol.Frame]) -> None:
    loader.store(msgspec.structs.replace(frames[0], checksum=frames[0].checksum ^ 1))
    loader.want([("run", 0), ("run", 8)])
    wait_for(lambda: loader.broken(("run", 0)) is not None)
    assert "checksum" in str(loader.broken(("run", 0)))
    loader.store(frames[8])

    wait_for(lambda: loader.get(("run", 8)) is not None)


def test_a_frame_of_an_unknown_run_is_not_kept(frames: list[protocol.Frame]) -> None:
    loader = FrameLoader()

    assert loader.store(frames[0]) is None
    assert not loader.has(("run", 0))
    loader.close()


def test_frames_that_gave_way_are_named(frames: list[protocol.Frame]) -> None:
    size = len(protocol.pack(frames[0]))
    loader = FrameLoader(packed_bytes_per_run=4 * size)
    loader.add_run("run", NROWS, NCOLS)
    gone = [index for frame in frames for index in loader.store(frame) or []]

    assert gone
    assert set(gone).isdisjoint(loader.indices("run"))
    assert set(gone) | set(loader.indices("run")) == set(range(COUNT))
    loader.close()


def test_few_decoded_frames_stay_but_never_less_than_is_wanted(frames: list[protocol.Frame]) -> None:
    loader = FrameLoader(decoded_bytes=1)
    loader.add_run("run", NROWS, NCOLS)
    for frame in frames:
        loader.store(frame)
    wanted = [("run", index) for index in range(12)]

    assert loader.wait(wanted, 5.0)
    assert loader.wait([("run", index) for index in range(20, 28)], 5.0)
    assert loader.get(("run", 0)) is None
    loader.close()


def test_the_depth_of_one_cell_is_traced_through_all_frames(
    loader: FrameLoader, frames: list[protocol.Frame]
) -> None:
    for frame in frames:
        loader.store(frame)
    loader.trace(10, 20, [("run", index) for index in range(COUNT)])
    wait_for(lambda: len(loader.traced()) == COUNT)
    traced = loader.traced()

    assert traced["run", 9] == (90.0, 0.0)
    assert traced["run", 30] == pytest.approx((300.0, 1.3), abs=frames[30].scale)
    loader.trace(0, 0, [("run", 0)])
    wait_for(lambda: loader.traced() == {("run", 0): (0.0, 0.0)})
