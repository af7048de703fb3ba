"""The script `fev` as a module, for the tests that look into it."""

import importlib.machinery
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture
def fev_script(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """A fresh module made from the script; nothing of it is run."""
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    loader = importlib.machinery.SourceFileLoader("fev_script", str(REPOSITORY / "fev"))
    specification = importlib.util.spec_from_loader("fev_script", loader)
    assert specification is not None
    module = importlib.util.module_from_spec(specification)
    loader.exec_module(module)
    return module
