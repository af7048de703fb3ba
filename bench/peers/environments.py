"""The peers and the environments they run in.

Each peer is installed from the package index that pip is set up for into a virtual environment of its own,
kept in `.cache/peers`; a second run of the bench finds it there.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / ".cache" / "peers"
INSTALL_SECONDS = 1200


class PeerMissing(Exception):
    """A peer that cannot run here; the text says what it lacks."""


@dataclass(frozen=True)
class Peer:
    """A flood solver, what it needs, and what it solves."""

    name: str
    script: str
    """Module `bench.peers.run_SCRIPT`."""
    scheme: str
    """Order, scheme and precision, for the table."""
    requirements: tuple[str, ...] = ()
    """What pip installs; nothing where it is this project itself."""
    python: str | None = None
    """Interpreter it needs, `3.12`; None is the present one."""
    tools: tuple[str, ...] = ()
    """Commands that its installation needs."""
    arguments: tuple[str, ...] = ()
    """Further arguments of its script."""


def has_gpu() -> bool:
    """Whether an NVIDIA device answers."""
    found = shutil.which("nvidia-smi")
    return found is not None and subprocess.run([found, "-L"], capture_output=True).returncode == 0


GEOSWE = "geoswe[gpu]==1.1.1" if has_gpu() else "geoswe==1.1.1"

PEERS = (
    Peer("FEV", "fev", "second order, MUSCL-Hancock, HLLC, float32"),
    Peer("FEV, 2 threads", "fev", "the same", arguments=("2",)),
    *((Peer("FEV, GPU", "fev", "the same", arguments=("cuda:0",)),) if has_gpu() else ()),
    Peer("ANUGA DE1", "anuga", "second order on triangles, Runge-Kutta 2, float64", ("anuga==4.1.0",)),
    Peer(
        "PyClaw",
        "pyclaw",
        "second order, wave propagation, augmented Riemann solver, float64",
        ("clawpack==5.14.0", "numpy", "six"),
        tools=("gfortran",),
    ),
    Peer("GeoSWE", "geoswe", "first order, HLLC, surface reconstruction", (GEOSWE,)),
    Peer("landlab", "landlab", "local inertia (no advection), float64", ("landlab==2.11.0",), python="3.12"),
)


def interpreter(wanted: str | None) -> str:
    """Path of the Python that a peer needs.

    Raises:
        PeerMissing: when there is none on the path.
    """
    if wanted is None or sys.version.startswith(f"{wanted}."):
        return sys.executable
    # A pyenv shim answers to a version only when that version is asked for.
    name, environment = f"python{wanted}", {**os.environ, "PYENV_VERSION": wanted}
    found = shutil.which(name)
    question = "import sys; print(sys.executable)"
    if found is not None:
        answer = subprocess.run([found, "-c", question], capture_output=True, text=True, env=environment)
        if answer.returncode == 0:
            return answer.stdout.strip()
    raise PeerMissing(f"needs the interpreter {name}, which is not on the path")


def python_of(peer: Peer) -> str:
    """Interpreter of the peer's environment, installed if need be.

    Raises:
        PeerMissing: naming the interpreter, the tool or the failed installation.
    """
    if not peer.requirements:
        return sys.executable
    folder = FOLDER / peer.requirements[0]
    done = folder / "installed"
    binary = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if done.exists():
        return str(binary)
    base = interpreter(peer.python)
    missing = [tool for tool in peer.tools if shutil.which(tool) is None]
    if missing:
        raise PeerMissing(f"needs {', '.join(missing)} to be built")
    if base == sys.executable:
        venv.create(folder, with_pip=True, clear=True)
    else:
        subprocess.run([base, "-m", "venv", "--clear", str(folder)], check=True)
    command = [str(binary), "-m", "pip", "install", "--quiet", *peer.requirements]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=INSTALL_SECONDS)
    except subprocess.TimeoutExpired:
        raise PeerMissing(f"pip took more than {INSTALL_SECONDS} s to install {peer.name}") from None
    except subprocess.CalledProcessError as failure:
        last = (failure.stderr.strip().splitlines() or ["no message"])[-1]
        raise PeerMissing(f"pip could not install {peer.name}: {last}") from None
    done.touch()
    return str(binary)
