"""Other flood solvers beside this one: one case, one machine, speed and error in one table.

Every solver, this one too, runs the case of `case.py` in a process of its own (`run_NAME.py`) on one
thread. A peer gets a virtual environment of its own from the package index; one that cannot be installed
is skipped with the reason. The errors are against fine runs of this solver, ANUGA and PyClaw, so
that none is judged by itself alone. `python -m bench.peers.table` writes the kept figures into
`docs/explanation/peers.md`.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench.peers.environments import PEERS, PeerMissing, python_of
from bench.peers.measures import Outcome, coarsen, errors, run

CELLS, CELLS_SMOKE = 512, 64
FINE = {"FEV": 4, "ANUGA DE1": 2, "PyClaw": 2}
"""Reference runs: how many times finer."""


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """One figure per peer: M cell-steps per CPU second, with steps, errors and the volume's error."""
    cells = CELLS_SMOKE if smoke else CELLS
    with tempfile.TemporaryDirectory() as folder:
        references: dict[str, Outcome] = {}
        for peer in PEERS:
            if peer.name in FINE and not (smoke and peer.name != "FEV"):
                fine = FINE[peer.name] * cells
                try:
                    outcome = run(python_of(peer), peer, fine, Path(folder))
                except PeerMissing as reason:
                    yield {"figure": f"{peer.name} at {fine} cells", "skipped": str(reason)}
                else:
                    references[f"{peer.name} at {fine} cells"] = coarsen(outcome, cells)
        for name, outcome in references.items():
            for other, reference in references.items():
                if name < other:
                    apart = errors(outcome, reference)["error_h_m"]
                    yield {"figure": f"{name} less {other}", "value": apart, "unit": "m"}
        for peer in PEERS:
            try:
                outcome = run(python_of(peer), peer, cells, Path(folder))
            except PeerMissing as reason:
                yield {"figure": peer.name, "skipped": str(reason)}
            else:
                yield figure_of(peer.name, peer.scheme, outcome, references)


def figure_of(name: str, scheme: str, outcome: Outcome, references: dict[str, Outcome]) -> dict[str, object]:
    """The line of one peer."""
    against = {title: errors(outcome, reference) for title, reference in references.items()}
    return {
        "figure": name,
        "value": outcome.cell_steps / outcome.cpu_s / 1e6,
        "unit": "M cell-steps/CPU s",
        "scheme": scheme,
        "version": outcome.version,
        "cells": outcome.h.size,
        "steps": outcome.steps,
        "cpu_s": outcome.cpu_s,
        "wall_s": outcome.wall_s,
        "volume_error_relative": outcome.volume_error,
        "errors": against,
    }
