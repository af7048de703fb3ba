"""How long to wait for what should take so long on a machine that does nothing else."""

import os

MOST = 4.0


def patient(seconds: float) -> float:
    """A deadline: as told on a quiet machine, up to four times as long where others want the processors."""
    if not hasattr(os, "getloadavg"):
        return seconds * MOST
    return seconds * min(max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1)), MOST)
