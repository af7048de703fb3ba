"""Collects the exact state of a run into a snapshot, and puts it back."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from solver_service.numerics.engine import Engine
from solver_service.numerics.fields import MAXIMA_NAMES, STATE_NAMES
from solver_service.numerics.forcing import Forcing
from solver_service.numerics.snapshot import Snapshot


def take_snapshot(engine: Engine, z_b: npt.NDArray, volumes: Mapping[str, float]) -> Snapshot:
    """The state between two steps.

    Args:
        engine: the engine, whose parts hold the state.
        z_b: bed [m], [nrows, ncols].
        volumes: `initial_volume` and `edits_volume` [m3].
    """
    parts = engine.parts
    store = parts.store
    arrays: dict[str, npt.NDArray] = {name: store.read(name) for name in (*STATE_NAMES, *MAXIMA_NAMES)}
    arrays["z_b"] = z_b
    arrays["class_arrival"] = store.read_class_arrival()
    arrays["edge_flow"] = store.edge_flow.numpy().copy()
    arrays["gauge_records"] = parts.gauges.records().copy()
    arrays |= parts.sections.snapshot()
    for part in parts.after_step:
        arrays |= part.snapshot()
    scalars = {
        "time": engine.time,
        "step_count": engine.step_count,
        "dt": engine.dt,
        "wave_speed": engine.wave_speed,
        **volumes,
    }
    return Snapshot(arrays, scalars)


def check_snapshot(engine: Engine, snapshot: Snapshot) -> None:
    """Refuse a snapshot of another model.

    Raises:
        ModelError: naming what is missing or of another size.
    """
    parts = engine.parts
    shape = (parts.store.nrows, parts.store.ncols)
    shapes: dict[str, tuple[int | None, ...]] = dict.fromkeys((*STATE_NAMES, *MAXIMA_NAMES, "z_b"), shape)
    shapes["class_arrival"] = (len(parts.store.arrival_depths), *shape)
    shapes["edge_flow"] = tuple(parts.store.edge_flow.shape)
    shapes["gauge_records"] = (None, parts.gauges.count, 4)
    shapes |= {
        "section_records": (None, parts.sections.count, 3),
        "section_totals": (parts.sections.count, 3),
    }
    for part in parts.after_step:
        shapes |= {name: array.shape for name, array in part.snapshot().items()}
    snapshot.check(shapes)


def with_new_rain(engine: Engine, snapshot: Snapshot) -> Snapshot:
    """A snapshot of a model that had no rain, as one of the engine's, of which nothing has fallen yet."""
    arrays = dict(snapshot.arrays)
    for part in engine.parts.after_step:
        if isinstance(part, Forcing):
            handed_out = np.asarray(arrays.get("released", np.zeros(0)), np.float64)
            rest = np.zeros(max(0, part.series_count - handed_out.size))
            arrays["released"] = np.concatenate([handed_out, rest])
    return Snapshot(arrays, snapshot.scalars)


def put_back(engine: Engine, snapshot: Snapshot) -> None:
    """Restore everything but the bed from a snapshot that was checked."""
    parts = engine.parts
    store = parts.store
    arrays, scalars = snapshot.arrays, snapshot.scalars
    for name in (*STATE_NAMES, *MAXIMA_NAMES):
        store.write(name, arrays[name])
    store.write_class_arrival(np.asarray(arrays["class_arrival"], np.float32))
    store.edge_flow.assign(np.asarray(arrays["edge_flow"], np.float64))
    parts.gauges.restore(arrays["gauge_records"])
    parts.sections.restore(arrays["section_records"], arrays["section_totals"])
    for part in parts.after_step:
        part.restore(arrays)
    engine.time, engine.dt = float(scalars["time"]), float(scalars["dt"])
    engine.step_count, engine.wave_speed = int(scalars["step_count"]), float(scalars["wave_speed"])
