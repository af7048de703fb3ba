"""What every test relies on: one BLAS thread, one seed, floating-point errors raised, a display for windows.

The environment is set while this file is imported, before NumPy, Warp and Qt read it.
"""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent

# Two threads of OpenBLAS beside Warp's own slow a 2-core machine down and make timings wander.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
# One kept folder for compiled kernels: the second run of the suite compiles nothing.
os.environ.setdefault("WARP_CACHE_PATH", str(REPOSITORY / ".cache" / "warp"))

import numpy as np  # noqa: E402
import pytest  # noqa: E402

SEED = 20111118


@pytest.fixture
def rng() -> np.random.Generator:
    """A generator with the same seed in every test."""
    return np.random.default_rng(SEED)


@pytest.fixture(autouse=True)
def _numpy_errors_are_raised() -> Iterator[None]:
    with np.errstate(divide="raise", over="raise", invalid="raise"):
        yield


@pytest.fixture(scope="session")
def display() -> Iterator[str]:
    """Name of an X display: the one given, else a virtual one; "" where the system has no X."""
    if not sys.platform.startswith("linux") or "DISPLAY" in os.environ:
        yield os.environ.get("DISPLAY", "")
        return
    if shutil.which("Xvfb") is None:
        pytest.skip("Xvfb is not installed, so no window can be tried (`./fev test` installs or names it)")
    ready, started = os.pipe()
    command = ["Xvfb", "-displayfd", str(started), "-screen", "0", "1600x1000x24", "-nolisten", "tcp"]
    server = subprocess.Popen(
        command, pass_fds=(started,), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    os.close(started)
    try:
        with os.fdopen(ready) as pipe:
            number = pipe.readline().strip()
        if not number:
            pytest.fail(f"Xvfb ended with status {server.wait()} before it opened a display")
        os.environ["DISPLAY"] = f":{number}"
        yield f":{number}"
    finally:
        os.environ.pop("DISPLAY", None)
        server.terminate()
        server.wait(timeout=10)


@pytest.fixture(scope="session")
def qapp_args(display: str) -> list[str]:
    """Arguments of the QApplication that pytest-qt makes; asking for the display makes sure of one."""
    return ["fev"]
