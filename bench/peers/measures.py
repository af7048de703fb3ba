"""One run of one peer, and how far its water is off."""

from __future__ import annotations

import os
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bench.peers import case
from bench.peers.environments import ROOT, Peer, PeerMissing

ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
DEPTH_WET = 0.05
"""Depth from which a cell counts as flooded [m]."""
RUN_SECONDS = 7200


@dataclass(frozen=True)
class Outcome:
    """What a run has computed and what it cost."""

    h: case.Array
    """Depth [m] on the common grid, row 0 in the south."""
    hu: case.Array
    """Unit discharge to the east [m2/s]."""
    hv: case.Array
    """Unit discharge to the north [m2/s]."""
    steps: int
    """Full time steps."""
    cpu_s: float
    """CPU time of the time loop, all threads [s]."""
    wall_s: float
    """Wall time of the time loop [s]."""
    volume_error: float
    """Relative change of the volume since the start, on the solver's own grid."""
    version: str
    """Version of the solver, with its backend."""

    @property
    def cell_steps(self) -> int:
        """Cells times full steps."""
        return self.h.size * self.steps


def run(python: str, peer: Peer, cells: int, folder: Path) -> Outcome:
    """Run a peer on `cells` x `cells` cells in a process of its own.

    Raises:
        PeerMissing: when the run fails; the text ends with its last words.
    """
    path = folder / f"{peer.script}_{cells}.npz"
    command = [python, "-m", f"bench.peers.run_{peer.script}", str(cells), str(path), *peer.arguments]
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": str(ROOT)}
    try:
        subprocess.run(
            command,
            cwd=folder,
            env=environment,
            check=True,
            capture_output=True,
            text=True,
            timeout=RUN_SECONDS,
        )
    except subprocess.TimeoutExpired:
        raise PeerMissing(f"ran for more than {RUN_SECONDS} s") from None
    except subprocess.CalledProcessError as failure:
        last = (failure.stderr.strip().splitlines() or ["no message"])[-1]
        raise PeerMissing(f"its run failed: {last}") from None
    with np.load(path) as data:
        fields = (np.asarray(data[name], np.float64) for name in ("h", "hu", "hv"))
        return Outcome(
            *fields,
            steps=int(data["steps"]),
            cpu_s=float(data["cpu_s"]),
            wall_s=float(data["wall_s"]),
            volume_error=float(data["volume_error"]),
            version=str(data["version"]),
        )


def coarsen(fine: Outcome, cells: int) -> Outcome:
    """A fine run as cell means on `cells` x `cells` cells."""
    ratio = fine.h.shape[0] // cells

    def mean(field: case.Array) -> case.Array:
        return field.reshape(cells, ratio, cells, ratio).mean(axis=(1, 3))

    return replace(fine, h=mean(fine.h), hu=mean(fine.hu), hv=mean(fine.hv))


def errors(outcome: Outcome, reference: Outcome) -> dict[str, float]:
    """Mean absolute errors of depth [m] and unit discharge [m2/s]; share of cells wrongly wet or dry."""
    off = np.abs(outcome.hu - reference.hu) + np.abs(outcome.hv - reference.hv)
    wet, truth = outcome.h > DEPTH_WET, reference.h > DEPTH_WET
    return {
        "error_h_m": float(np.abs(outcome.h - reference.h).mean()),
        "error_discharge_m2_s": float(off.mean()),
        "wrongly_wet_or_dry": float((wet != truth).mean()),
    }
