"""Runs a snippet in a process that has confined itself, and gives what it printed."""

import os
import subprocess
import sys

import msgspec

from solver_service.uploads.import_messages import ImportLimits

HEAD = """
import os, sys
import msgspec
from solver_service.uploads.confinement import confine
from solver_service.uploads.import_messages import ImportLimits
confine(msgspec.json.decode(sys.argv[1], type=ImportLimits), os.getppid())
def attempt(name, call):
    try:
        call()
        print(name, "done", flush=True)
    except OSError as error:
        print(name, type(error).__name__, flush=True)
"""


def run_confined(snippet: str, limits: ImportLimits | None = None) -> subprocess.CompletedProcess[str]:
    """What happens to a snippet under limits."""
    words = msgspec.json.encode(limits or ImportLimits()).decode()
    return subprocess.run(
        [sys.executable, "-c", HEAD + snippet, words],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env=dict(os.environ),
    )
