from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from protocol import BlockLayout, FrameEncoder, limits
from protocol.depth_codec import quantise_depth
from solver_service.errors import StoreError
from solver_service.runs.frame_grouping import FrameGrouping, grouping_after, open_key_frame
from solver_service.store import DataFolder, FrameReader, FrameWriter, RunDatabase, RunRecord

LAYOUT = BlockLayout(40, 50)
RUN = RunRecord("r1", "case", "f00d", "Title", None, 0, "running", "", 100.0, 5.0, "auto", 0, b"[]", b"{}")


def water(depth: float) -> np.ndarray:
    return np.full((40, 50), depth, np.float32)


def quantiser(h: np.ndarray) -> Callable[[float], tuple[np.ndarray, np.ndarray]]:
    def quantise(scale: float) -> tuple[np.ndarray, np.ndarray]:
        q = quantise_depth(h, scale, 1e-3)
        return q, LAYOUT.classify(q)

    return quantise


def scale_of(grouping: FrameGrouping, index: int, depth: float) -> float:
    return grouping.quantise(index, quantiser(water(depth)), lambda: depth)[2]


def test_a_group_keeps_its_scale_until_it_is_full_or_the_water_no_longer_fits() -> None:
    grouping = FrameGrouping()
    first = scale_of(grouping, 4, 3.0)
    assert grouping.end == 4 + limits.FRAME_GROUP
    assert scale_of(grouping, 5, 0.1) == first
    coarser = scale_of(grouping, 9, 1000.0 * first * 65535)
    assert coarser > first
    assert grouping.end == 9 + limits.FRAME_GROUP
    assert scale_of(grouping, 9 + limits.FRAME_GROUP, 0.1) < coarser


@pytest.mark.parametrize("cut", [1, 5, 31, 32, 33, 40])
def test_frames_after_an_interruption_are_those_without_it_byte_for_byte(tmp_path: Path, cut: int) -> None:
    depths = [1.0 + 0.05 * k + (900.0 if k >= 38 else 0.0) for k in range(45)]

    def frames(grouping: FrameGrouping, encoder: FrameEncoder, first: int, last: int) -> list[bytes]:
        packed = []
        for index in range(first, last):
            h = water(depths[index])
            q, states, scale = grouping.quantise(index, quantiser(h), lambda h=h: float(h.max()))
            packed.append(encoder.encode("r1", index, 5.0 * index, 0, (q, states), scale=scale))
        return packed

    truth = frames(FrameGrouping(), FrameEncoder(LAYOUT), 0, 45)
    folder = DataFolder(tmp_path)
    database = RunDatabase(folder.database)
    database.begin_epoch()
    database.insert_run(RUN)
    writer, reader = FrameWriter(folder, database, "r1"), FrameReader(folder)
    keys = [index for index in (0, 32, 38)]
    for index in range(cut):
        key = max(k for k in keys if k <= index)
        writer.append(index=index, time=5.0 * index, revision=0, key_index=key, frame=truth[index])
    open_key = open_key_frame(database, reader, "r1")
    encoder = FrameEncoder(LAYOUT)
    if open_key is not None:
        encoder.go_on(open_key)
    assert (open_key is None) == (cut == 32)
    assert frames(grouping_after(open_key), encoder, cut, 45) == truth[cut:]
    writer.close()
    database.close()


def test_a_damaged_key_frame_is_told_and_a_run_without_frames_begins_anew(tmp_path: Path) -> None:
    folder = DataFolder(tmp_path)
    database = RunDatabase(folder.database)
    database.begin_epoch()
    database.insert_run(RUN)
    assert open_key_frame(database, FrameReader(folder), "r1") is None
    assert grouping_after(None) == FrameGrouping()
    writer = FrameWriter(folder, database, "r1")
    row = writer.append(index=0, time=0.0, revision=0, key_index=0, frame=b"not a frame at all")
    writer.close()
    (folder.frames("r1") / row.segment).write_bytes(b"torn")
    with pytest.raises(StoreError, match="damaged"):
        open_key_frame(database, FrameReader(folder), "r1")
    database.close()
