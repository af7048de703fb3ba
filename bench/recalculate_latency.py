"""From Recalculate to the first changed frame, between real processes over a real socket.

For each of N recalculations an edit that stands in the water of the branch frame is sent, then Recalculate at
that frame; the clock runs from the moment it is sent until (a) the child's first frame, the one at the branch
time itself, is received and decoded, and (b) the first frame is decoded that differs from the parent's frame
of the same index.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from protocol import BlockLayout, DecodedFrame, EditLine, EditType, GridGeometry, Operation

COUNT = 20
FIRST_INDEX = 4
STRIDE = 2


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Latencies on the embedded case, and on the 0.7 million cells of Malpasset where its data is at hand."""
    yield from _measure("jacksboro", 4 if smoke else COUNT)
    yield from _measure("jacksboro", 4 if smoke else COUNT, keep_parent=True)
    home = os.environ.get("FEV_DATA_HOME")
    if not smoke and home and (Path(home) / "malpasset").is_dir():
        yield from _measure("malpasset", COUNT)


def _measure(case: str, count: int, keep_parent: bool = False) -> Iterator[dict[str, object]]:
    with (
        tempfile.TemporaryDirectory(prefix="fev-bench-") as folder,
        ServiceProcess(Path(folder)) as service,
        ServiceClient(service) as clerk,
    ):
        run = str(clerk.do(protocol.StartRun, case=case)["run"])
        clerk.do(protocol.ReleaseControl, run=run)
        info = next(info for info in clerk.ask(protocol.ListRuns).runs if info.run == run)
        layout = BlockLayout(info.grid.nrows, info.grid.ncols)
        first, changed, asked = [], [], []
        with ServiceClient(service, layout=layout) as client:
            client.do(protocol.Subscribe, run=run, from_index=0, mode="replay", credit=8)
            for number in range(count):
                index = FIRST_INDEX + STRIDE * number
                while (run, index + 3) not in client.decoded:
                    client.first(protocol.Frame)
                before = {k: client.decoded[run, k] for k in range(index, index + 4)}
                edit = _levee_in_the_water(f"levee{number}", before[index], info.grid.geometry)
                revision = client.do(protocol.AppendEdit, run=run, edit=edit)["revision"]
                ack_s, first_s, changed_s, child = _recalculate(
                    client, run, index, revision, before, keep_parent
                )
                asked.append(ack_s)
                first.append(first_s)
                changed.append(changed_s)
                if keep_parent:
                    client.ask(protocol.StopRun, run=run)  # or all workers would be taken soon
                run = child
    for name, values in (("ack", asked), ("first_frame", first), ("first_changed_frame", changed)):
        for quantile in (50, 95):
            yield {
                "figure": f"recalculate{'_keep_parent' if keep_parent else ''}_to_{name}_p{quantile}",
                "value": round(float(np.percentile(values, quantile)), 4),
                "unit": "s",
                "case": case,
                "cells": info.grid.nrows * info.grid.ncols,
                "count": count,
            }


def _recalculate(
    client: ServiceClient,
    run: str,
    index: int,
    revision: int,
    before: dict[int, DecodedFrame],
    keep_parent: bool,
) -> tuple[float, float, float, str]:
    command = protocol.Recalculate(client.session.next_id(), run, index, revision, keep_parent)
    begun = time.perf_counter()
    client.send(command)
    ack = client.first(protocol.Ack, lambda answer: answer.id == command.id)
    ack_s = time.perf_counter() - begun
    child = str(ack.result["run"])
    client.first(protocol.Frame, lambda frame: frame.run == child)
    first_s = time.perf_counter() - begun
    k = index
    while np.array_equal(client.decoded[child, k].q * 1.0, _same_scale(before[k], client.decoded[child, k])):
        k += 1
        client.frame(child, k)
    return ack_s, first_s, time.perf_counter() - begun, child


def _same_scale(frame: DecodedFrame, like: DecodedFrame) -> np.ndarray:
    return frame.q * 1.0 if frame.scale == like.scale else np.rint(frame.h / like.scale)


def _levee_in_the_water(name: str, frame: DecodedFrame, grid: GridGeometry) -> EditLine:
    """A levee of 60 cells in the row that has half of the water to its south."""
    rows, cols = np.nonzero(frame.q)
    row = int(rows[rows.size // 2])
    in_row = cols[rows == row]
    col = int(in_row[in_row.size // 2])
    ends = [grid.center(row, max(col - 30, 1)), grid.center(row, min(col + 30, grid.ncols - 2))]
    return EditLine(
        id=name,
        vertices=(ends[0], ends[1]),
        width=2.0 * grid.dx,
        operation=Operation.raise_,
        type=EditType.modulate,
        magnitude=5.0,
    )
