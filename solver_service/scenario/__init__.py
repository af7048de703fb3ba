"""Cases: data sets with their forcing, read from case files and checked key by key."""

from solver_service.scenario.case import Case, DemoScript, Gauge
from solver_service.scenario.case_folder import CaseFolder, open_case
from solver_service.scenario.catalogue import case_summary, list_cases, load_case, summary_of

__all__ = [
    "Case",
    "CaseFolder",
    "DemoScript",
    "Gauge",
    "case_summary",
    "list_cases",
    "load_case",
    "open_case",
    "summary_of",
]
