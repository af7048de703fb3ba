"""The command `fev-solver`: run cases, check them, serve them."""

from solver_service.cli.app import app, main

__all__ = ["app", "main"]
