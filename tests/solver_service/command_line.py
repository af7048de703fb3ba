"""The command line within the process of the test: exit code, standard output, standard error."""

import sys
from dataclasses import dataclass

import pytest

from solver_service.cli import main


@dataclass(frozen=True)
class Answer:
    code: int
    out: str
    err: str


def fev_solver(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], *words: object) -> Answer:
    """Run `fev-solver` with the words given."""
    monkeypatch.setattr(sys, "argv", ["fev-solver", *map(str, words)])
    monkeypatch.setenv("TERM", "dumb")
    capfd.readouterr()
    code = 0
    try:
        main()
    except SystemExit as end:
        code = int(end.code or 0)
    captured = capfd.readouterr()
    return Answer(code, captured.out, captured.err)
