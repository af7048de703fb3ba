"""`fev-solver check` and `fev-solver cases`."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import msgspec

from solver_service.errors import ServiceError
from solver_service.offline import check_case, write_geojson
from solver_service.scenario import case_summary, list_cases, load_case


def check_and_tell(name: str, device: str, json_line: bool, geojson: Path | None = None) -> None:
    """Check a case and print what was found.

    Args:
        name: name or path of the case.
        device: where it would run.
        json_line: end with a JSON object instead of a table.
        geojson: file for the cells and faces of everything on the grid; None writes none.

    Raises:
        ServiceError: the case cannot be loaded, or the device is absent.
    """
    case = load_case(name)
    if geojson is not None:
        write_geojson(geojson, case)
    report = check_case(case, device)
    if json_line:
        print(json.dumps({"case": case.name, **report.figures, "warnings": report.warnings}), flush=True)
        return
    print(f"{case.title}{' (hypothetical)' if case.hypothetical else ''}")
    for label, value in report.facts:
        print(f"  {label:<22}{value}")
    if case.licence or case.source:
        print(f"  {'data':<22}{case.source or 'source not said'}; licence: {case.licence or 'not said'}")
    for warning in report.warnings:
        print(f"  warning: {warning}")
    if not report.warnings:
        print("  nothing odd was found")


def tell_cases(json_line: bool) -> None:
    """Print the cases that have a name; one that cannot be read is told on standard error."""
    summaries = []
    for name in list_cases():
        try:
            summaries.append(case_summary(name))
        except ServiceError as error:
            print(f"fev-solver: {error}", file=sys.stderr)
    if json_line:
        print(json.dumps(msgspec.to_builtins(summaries)), flush=True)
        return
    for case in summaries:
        mark = ", hypothetical" if case.hypothetical else ""
        print(f"{case.name:<16}{case.title} ({case.nrows} x {case.ncols} cells of {case.dx:g} m{mark})")
