"""Runs: the tree of runs, the worker processes that compute them, and the commands that change them."""

from solver_service.runs.audience import Listener
from solver_service.runs.controllers import Session
from solver_service.runs.housekeeper import RoomRules
from solver_service.runs.registry import RunRegistry
from solver_service.runs.run_status import RunStatus
from solver_service.runs.run_tree import Run
from solver_service.runs.worker_watch import Patience

__all__ = ["Listener", "Patience", "RoomRules", "Run", "RunRegistry", "RunStatus", "Session"]
