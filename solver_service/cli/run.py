"""`fev-solver run`: a progress bar on a terminal, then a table or one line of JSON."""

from __future__ import annotations

import json
import signal
import sys
from typing import Any

from solver_service.offline import OfflineOptions, run_case
from solver_service.scenario import load_case

ROWS = (
    ("cells", "cells", "{:,.0f}"),
    ("steps", "steps", "{:,.0f}"),
    ("simulated time", "sim_time_s", "{:,.0f} s"),
    ("wall time", "wall_s", "{:,.1f} s"),
    ("faster than real time", "speed_x_real_time", "{:,.1f} x"),
    ("cell-steps a second", "cell_steps_per_s", "{:,.0f}"),
    ("water volume error", "volume_error_relative", "{:.1e}"),
    ("largest depth", "max_depth_m", "{:.1f} m"),
    ("largest speed", "max_speed_m_s", "{:.1f} m/s"),
    ("device", "device", "{}"),
)


SHOWN = 1e-3
"""Smaller volumes [m3] wait in a structure for the next quantum of water."""


def run_offline(name: str, options: OfflineOptions, cell_size: float | None, json_line: bool) -> None:
    """Run a case and tell its figures.

    Args:
        name: name or path of the case.
        options: how it is run.
        cell_size: cell size instead of the case's [m].
        json_line: end with a JSON object instead of a table.

    Raises:
        ServiceError: the case, an option, the device or the output is not usable.
    """
    import warp as wp

    wp.config.log_level = wp.LOG_ERROR
    # An end by a signal unwinds like any other, so that no half-written folder stays behind.
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))
    case = load_case(name, cell_size)
    summary = _with_progress(case.title, lambda on_frame: run_case(case, options, on_frame))
    if json_line:
        print(json.dumps(summary), flush=True)
        return
    _tell(summary)
    if options.out is not None:
        print(f"results in {options.out}")


def _with_progress(title: str, job: Any) -> dict[str, Any]:
    """Do the job with a progress bar on standard error where that is a terminal."""
    if not sys.stderr.isatty():
        result: dict[str, Any] = job(None)
        return result
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.percentage:3.0f} %"))
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True)) as progress:
        task = progress.add_task(title, total=None)
        result = job(lambda time, until: progress.update(task, completed=time, total=until))
        return result


def _tell(summary: dict[str, Any]) -> None:
    mark = " (hypothetical)" if summary["hypothetical"] else ""
    print(f"{summary['title']}{mark}")
    for label, key, form in ROWS:
        print(f"  {label:<24}{form.format(summary[key])}")
    for label, volume in _budget(summary["water_budget_m3"]):
        print(f"  {label:<24}{volume:,.6g} m3")
    step = summary["smallest_mean_step"]
    place = f"cell (row {step['row']}, column {step['col']}) at {step['time_s']:g} s"
    print(f"  {'smallest mean step':<24}{step['dt_s']:.3g} s, limited by {place}")
    for warning in summary["warnings"]:
        print(f"  warning: {warning}")
    if summary["licence"]:
        print(f"  {'data':<24}{summary['source'] or 'source not said'}; licence: {summary['licence']}")


def _budget(budget: dict[str, Any]) -> list[tuple[str, float]]:
    """The volumes of the water budget that are worth showing, with their names."""
    rows = [("water at the start", budget["initial"]), ("rain", budget["rain"])]
    rows += [(f"source {name}", volume) for name, volume in budget["sources"].items()]
    for name, volumes in budget["edges"].items():
        rows += [(f"in through {name}", volumes["in"]), (f"out through {name}", -volumes["out"])]
    rows += [(f"structure {name}", -volume) for name, volume in budget["structures"].items()]
    rows += [("into the ground", -budget["infiltration"]), ("cut by edits", -budget["edits"])]
    return [
        *((name, volume) for name, volume in rows if abs(volume) >= SHOWN),
        ("water at the end", budget["stored"]),
    ]
