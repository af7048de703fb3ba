"""The tiny case without water, to which a test adds what it is about."""

from pathlib import Path

import numpy as np

from solver_service.scenario import Case, load_case
from tests.solver_service.tiny_case import CASE, write_case

POOL = CASE[CASE.index("[[initial.level]]") : CASE.index("[[boundary]]")]
DRY = CASE.replace(POOL, "")


def loaded(folder: Path, more: str, bed: np.ndarray | None = None) -> Case:
    """The dry case with more tables."""
    return load_case(write_case(folder, DRY + more, bed))
