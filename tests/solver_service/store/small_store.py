"""A store with whole frames, checkpoints and terrain, made without a solver."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from protocol import BlockLayout, FrameEncoder, peek_frame
from solver_service.store import (
    CheckpointStore,
    DataFolder,
    FrameReader,
    FrameWriter,
    RunDatabase,
    RunRecord,
    StoredState,
    save_bed,
)

SHAPE = (40, 50)
LAYOUT = BlockLayout(*SHAPE)
RUN = RunRecord("r1", "case", "f00d", "Title", None, 0, "finished", "", 1e3, 5.0, "auto", 0, b"\x90", b"{}")


class SmallStore:
    """Rows and files of run r1, which has 40 frames with channels in many segments, and of r2, its child."""

    def __init__(self, root: Path) -> None:
        self.folder = DataFolder(root)
        self.database = RunDatabase(self.folder.database)
        self.database.begin_epoch()
        save_bed(self.folder, "f00d", np.zeros(SHAPE, np.float32))
        self.add(RUN, 40, segment_bytes=1)
        self.add(replace(RUN, run="r2", parent="r1", branch_index=3), 6)

    def add(self, record: RunRecord, count: int, segment_bytes: int = 1 << 20) -> None:
        """Store a run with so many frames and three checkpoints."""
        self.database.insert_run(record)
        rng = np.random.default_rng(len(record.run) + record.branch_index)
        encoder = FrameEncoder(LAYOUT)
        writer = FrameWriter(self.folder, self.database, record.run, segment_bytes)
        for index in range(record.branch_index, record.branch_index + count):
            frame = encoder.encode(record.run, index, 5.0 * index, 0, rng.random(SHAPE))
            writer.append(
                index=index,
                time=5.0 * index,
                revision=0,
                key_index=peek_frame(frame).key_index,
                frame=frame,
                channels={"maxima": rng.bytes(50), "velocity": rng.bytes(200)}
                if index % 4 == 0
                else {"velocity": rng.bytes(200)},
            )
        writer.close()
        checkpoints = CheckpointStore(self.folder, self.database)
        for step in range(3):
            state = StoredState(float(step), step, {"h": rng.random(SHAPE)}, {"time": float(step)})
            checkpoints.write(record.run, state)

    def frames(self, run: str) -> list[bytes]:
        """The bytes of all frames of a run."""
        reader = FrameReader(self.folder)
        return [reader.read(frame) for frame in self.database.frames(run)]

    def channels(self, run: str) -> dict[tuple[int, str], bytes]:
        """The bytes of all channels of a run, by frame and name."""
        reader = FrameReader(self.folder)
        return {(each.index, each.channel): reader.read(each) for each in self.database.channels(run)}

    def damage(self, path: Path) -> None:
        """Turn a byte in the middle of a file over."""
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 0xFF
        path.write_bytes(content)
