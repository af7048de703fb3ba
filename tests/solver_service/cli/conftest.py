"""`fev_solver(...)` runs the command line within the test."""

from collections.abc import Callable

import pytest

from tests.solver_service import command_line


@pytest.fixture
def fev_solver(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> Callable[..., command_line.Answer]:
    return lambda *words: command_line.fev_solver(monkeypatch, capfd, *words)
