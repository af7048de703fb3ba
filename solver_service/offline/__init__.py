"""Running a case without the web: results as maps, tables and timesteps in a folder."""

from solver_service.offline.case_check import CaseReport, check_case
from solver_service.offline.case_features import write_geojson
from solver_service.offline.output_folder import output_folder
from solver_service.offline.run_case import OfflineOptions, run_case
from solver_service.offline.timesteps import NetcdfTimesteps, TimestepFacts, ZarrTimesteps

__all__ = [
    "CaseReport",
    "NetcdfTimesteps",
    "OfflineOptions",
    "TimestepFacts",
    "ZarrTimesteps",
    "check_case",
    "output_folder",
    "run_case",
    "write_geojson",
]
