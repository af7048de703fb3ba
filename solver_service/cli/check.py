"""`fev-solver check` and `fev-solver cases`."""

from __future__ import annotations

import json
import sys

import msgspec

from solver_service.errors import ServiceError
from solver_service.offline import check_case
from solver_service.scenario import case_summary, list_cases, load_case


def check_and_tell(name: str, device: str, json_line: bool) -> None:
    """Check a case and print what was found.

    Raises:
        ServiceError: the case cannot be loaded, or the device is absent.
    """
    case = load_case(name)
    report = check_case(case, device)
    if json_line:
        print(json.dumps({"case": case.name, **report.figures, "warnings": report.warnings}), flush=True)
        return
    print(f"{case.title}{' (hypothetical)' if case.hypothetical else ''}")
    for label, value in report.facts:
        print(f"  {label:<22}{value}")
    if case.licence or case.source:
        print(f"  {'data':<22}{case.source}; licence: {case.licence or 'not said'}")
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
