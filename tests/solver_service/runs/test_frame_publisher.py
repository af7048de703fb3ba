import errno
import os
import queue
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from protocol import BlockLayout, FrameDecoder, peek_frame
from solver_service.errors import StoreError, StoreFull
from solver_service.runs.frame_publisher import FramePublisher
from solver_service.runs.quantised_frame import QuantisedFrame
from solver_service.runs.worker_messages import FrameStored
from solver_service.store import DataFolder, FrameReader, RunDatabase, RunRecord

RUN = RunRecord("r1", "case", "f00d", "Title", None, 0, "running", "", 100.0, 5.0, "auto", 0, b"[]", b"{}")
LAYOUT = BlockLayout(40, 50)


class Desk:
    """A publisher with what it reports in queues."""

    def __init__(self, root: Path) -> None:
        self.folder = DataFolder(root)
        self.database = RunDatabase(self.folder.database)
        self.stored: queue.Queue[FrameStored] = queue.Queue()
        self.trouble: queue.Queue[StoreError] = queue.Queue()
        epoch = self.database.begin_epoch()
        self.database.insert_run(RUN)
        self.publisher = FramePublisher(
            self.folder, epoch, self.stored.put, lambda run, error: self.trouble.put(error)
        )


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    desk = Desk(tmp_path)
    yield desk
    desk.publisher.close()
    desk.database.close()


def frame(index: int, rng: np.random.Generator, scale: float = 0.001) -> QuantisedFrame:
    q = rng.integers(0, 5, (40, 50), dtype=np.uint16)
    return QuantisedFrame("r1", index, 5.0 * index, 3, q, LAYOUT.classify(q), scale)


def test_frames_are_stored_in_order_and_decode_to_what_was_handed_over(
    desk: Desk, rng: np.random.Generator
) -> None:
    frames = [frame(index, rng) for index in range(5)]
    for each in frames:
        desk.publisher.publish(each)
    decoder, reader = FrameDecoder(LAYOUT), FrameReader(desk.folder)
    for each in frames:
        row = desk.stored.get(timeout=5.0).frame
        packed = peek_frame(reader.read(row))
        assert (row.index, row.key_index, row.revision, row.time) == (each.index, 0, 3, 5.0 * each.index)
        np.testing.assert_array_equal(decoder.decode(packed).q, each.q)


def test_another_scale_begins_another_group(desk: Desk, rng: np.random.Generator) -> None:
    for index, scale in enumerate((0.001, 0.001, 0.002, 0.002)):
        desk.publisher.publish(frame(index, rng, scale))
    assert [desk.stored.get(timeout=5.0).frame.key_index for _ in range(4)] == [0, 0, 2, 2]


def test_on_a_full_disk_the_frame_stays_in_hand_and_is_stored_when_there_is_space_again(
    desk: Desk, rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    desk.publisher.publish(frame(0, rng))
    desk.stored.get(timeout=5.0)

    def no_space(descriptor: int, content: bytes) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("solver_service.store.frame_files.os.write", no_space)
    desk.publisher.publish(frame(1, rng))
    trouble = desk.trouble.get(timeout=5.0)
    assert isinstance(trouble, StoreFull)
    assert "No space left on device" in str(trouble)
    assert [row.index for row in desk.database.frames("r1")] == [0]
    desk.publisher.retry()
    desk.trouble.get(timeout=5.0)
    monkeypatch.undo()
    desk.publisher.retry()
    assert desk.stored.get(timeout=5.0).frame.index == 1
    assert [row.index for row in desk.database.frames("r1")] == [0, 1]


def test_handing_a_frame_over_does_not_wait_for_the_disk(desk: Desk, rng: np.random.Generator) -> None:
    waits = [desk.publisher.publish(frame(index, rng)) for index in range(3)]
    assert max(waits) < 0.05
    assert all(desk.stored.get(timeout=5.0).waited_s < 0.05 for _ in waits)
