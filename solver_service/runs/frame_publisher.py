"""From the solver to the store: encode, append, commit and tell, on a thread of its own.

The solver hands over the rasters of a frame and goes on; it waits only when the disk is so slow that the
queue is full.
When the store fails (a full disk) nothing is lost: the frame stays in hand, the run is told to pause, and
`retry` tries again. A run that is taken up leans on the key frame that is open in its store, so that its
bytes are those of a run that nothing disturbed.
"""

from __future__ import annotations

import logging
import queue
import threading
import time as clock
from collections.abc import Callable

from protocol import BlockLayout, Frame, FrameEncoder, ProtocolError, peek_frame
from solver_service.errors import StoreError
from solver_service.runs.frame_grouping import open_key_frame
from solver_service.runs.quantised_frame import QuantisedFrame, pack_channels
from solver_service.runs.worker_messages import FrameStored
from solver_service.store import DataFolder, FrameReader, FrameWriter, RunDatabase

LOG = logging.getLogger(__name__)

QUEUE_BYTES = 128 * 1024 * 1024
"""Frames that may wait for the disk; a full queue makes the solver wait."""


class FramePublisher:
    """Stores frames in the order in which they come and reports each once it has its row."""

    def __init__(
        self,
        folder: DataFolder,
        epoch: int,
        report: Callable[[FrameStored], None],
        trouble: Callable[[str, StoreError], None],
    ) -> None:
        """Start the thread.

        Args:
            folder: the data folder.
            epoch: epoch of the service.
            report: called with each stored frame.
            trouble: called with the run and what was raised when a frame cannot be stored.
        """
        self._folder = folder
        self._epoch = epoch
        self._reader = FrameReader(folder)
        self._report = report
        self._trouble = trouble
        self._space = threading.Condition()
        self._handed = self._handed_bytes = 0  # written by the solver's thread alone
        self._stored = self._stored_bytes = 0  # written by this one's alone
        self._in_trouble = False
        self._queue: queue.Queue[tuple[QuantisedFrame, float, float] | Callable[[], None] | None]
        self._queue = queue.Queue()
        self._retry = threading.Event()
        self._closing = False
        self._encoder: FrameEncoder | None = None
        self._encoder_of: tuple[str, tuple[int, ...]] | None = None
        self._writer: FrameWriter | None = None
        self._thread = threading.Thread(target=self._work, name="frame-publisher", daemon=True)
        self._thread.start()

    def publish(self, frame: QuantisedFrame) -> float:
        """Hand a frame over; its arrays must not change afterwards.

        Returns:
            How long the caller waited [s].
        """
        begun = clock.perf_counter()
        if not self._has_space:  # no lock is asked for otherwise: whoever holds it may not get a processor
            with self._space:
                self._space.wait_for(lambda: self._has_space or self._in_trouble)
        self._handed_bytes += frame.nbytes
        self._handed += 1
        waited = clock.perf_counter() - begun
        self._queue.put((frame, begun, waited))
        return waited

    def settle(self) -> bool:
        """Wait until everything handed over is stored; False when a frame cannot be stored for now."""
        with self._space:
            self._space.wait_for(lambda: self._stored == self._handed or self._in_trouble)
            return self._stored == self._handed

    def then(self, call: Callable[[], None]) -> None:
        """Have something called once everything handed over so far is stored."""
        self._queue.put(call)

    def retry(self) -> None:
        """Try again to store the frame that could not be stored."""
        with self._space:
            self._in_trouble = False
        self._retry.set()

    def close(self) -> None:
        """Store what can be stored and end the thread; a frame in trouble is dropped (it has no row)."""
        self._closing = True
        self._retry.set()
        self._queue.put(None)
        self._thread.join()

    @property
    def _has_space(self) -> bool:
        return self._handed_bytes - self._stored_bytes < QUEUE_BYTES

    def _work(self) -> None:
        database = RunDatabase(self._folder.database, self._epoch)
        while (job := self._queue.get()) is not None:
            if callable(job):
                job()
                continue
            self._store(*job, database)
            with self._space:
                self._stored_bytes += job[0].nbytes
                self._stored += 1
                self._space.notify_all()
        if self._writer is not None:
            self._writer.close()
        database.close()

    def _store(self, frame: QuantisedFrame, begun: float, waited: float, database: RunDatabase) -> None:
        encoder, writer = self._tools(frame, database)
        water = (frame.q, frame.states)
        packed = encoder.encode(
            frame.run, frame.index, frame.time, frame.revision, water, scale=frame.scale, bed=frame.bed
        )
        key_index = peek_frame(packed).key_index
        channels = pack_channels(frame, encoder.layout)
        while True:
            try:
                record = writer.append(
                    index=frame.index,
                    time=frame.time,
                    revision=frame.revision,
                    key_index=key_index,
                    frame=packed,
                    channels=channels,
                )
            except StoreError as error:
                self._retry.clear()
                if self._is_closing():
                    return
                with self._space:
                    self._in_trouble = True
                    self._space.notify_all()
                self._trouble(frame.run, error)
                self._retry.wait()
                if self._is_closing():
                    return
            else:
                self._report(FrameStored(record, waited, clock.perf_counter() - begun))
                return

    def _is_closing(self) -> bool:
        return self._closing

    def _tools(self, frame: QuantisedFrame, database: RunDatabase) -> tuple[FrameEncoder, FrameWriter]:
        """Encoder and writer; a run that is taken up goes on in a segment of its own."""
        wanted = (frame.run, frame.q.shape)
        if self._encoder is None or self._writer is None or self._encoder_of != wanted:
            if self._writer is not None:
                self._writer.close()
            nrows, ncols = frame.q.shape
            self._encoder = FrameEncoder(BlockLayout(nrows, ncols))
            key = self._open_key(frame.run, database)
            if key is not None:
                self._encoder.go_on(key)
            self._writer = FrameWriter(self._folder, database, frame.run)
            self._encoder_of = wanted
        return self._encoder, self._writer

    def _open_key(self, run: str, database: RunDatabase) -> Frame | None:
        try:
            return open_key_frame(database, self._reader, run)
        except (StoreError, ProtocolError) as error:
            LOG.warning("run %s goes on with a new key frame: %s", run, error)
            return None
