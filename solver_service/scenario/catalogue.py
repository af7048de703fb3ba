"""Cases by name: the embedded ones, those of FEV_DATA_HOME, and any folder or archive by its path."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from protocol import CaseSummary
from solver_service.errors import CaseError
from solver_service.scenario import malpasset
from solver_service.scenario.case import Case
from solver_service.scenario.case_file import need, planned_grid, read_case, read_top
from solver_service.scenario.case_folder import ARCHIVE_SUFFIX, CASE_FILE, CaseFolder, open_case
from solver_service.scenario.run_settings import read_times

EMBEDDED = Path(__file__).parents[1] / "cases"


def load_case(name: str | Path, cell_size: float | None = None) -> Case:
    """Load a case.

    Args:
        name: name of an embedded case or of one in FEV_DATA_HOME, else the path of a folder with a case.toml,
            of a case file, or of a .fevcase archive. Names win over paths.
        cell_size: cell size to compute with instead of the case's [m].

    Raises:
        ServiceError: there is no such case, or it is not valid.
    """
    if cell_size is not None and not 1e-3 <= cell_size <= 1e5:
        raise CaseError(f"The cell size is {cell_size:g} m; 0.001 to 100000 m is allowed.")
    with _find(str(name)) as folder:
        return read_case(folder, cell_size)


def list_cases(others: Sequence[str] = ()) -> list[str]:
    """Names of the embedded cases, of those of FEV_DATA_HOME, and the others given, in this order."""
    names = sorted(path.parent.name for path in EMBEDDED.glob(f"*/{CASE_FILE}"))
    home = _data_home()
    if home is not None:
        names += sorted(path.parent.name for path in home.glob(f"*/{CASE_FILE}"))
        names += sorted(path.stem for path in home.glob(f"*{ARCHIVE_SUFFIX}"))
    return list(dict.fromkeys([*names, *map(str, others)]))


def case_summary(name: str | Path) -> CaseSummary:
    """A case in a few words; its terrain is read only where the case file does not say the grid.

    Raises:
        ServiceError: there is no such case, or it is not valid.
    """
    with _find(str(name), need_terrain=False) as folder:
        top = read_top(folder)
        about = need(top, "case")
        duration, interval = read_times(need(top, "run"))
        grid = planned_grid(folder) or read_case(folder).grid
        return CaseSummary(
            name=about.text("name", longest=64),
            title=about.text("title", about.text("name"), longest=200),
            hypothetical=about.flag("hypothetical"),
            nrows=grid.nrows,
            ncols=grid.ncols,
            dx=grid.dx,
            duration=duration,
            output_interval=interval,
            source=about.text("source", ""),
            licence=about.text("licence", ""),
        )


def summary_of(case: Case) -> CaseSummary:
    """A loaded case in a few words."""
    return CaseSummary(
        name=case.name,
        title=case.title,
        hypothetical=case.hypothetical,
        nrows=case.grid.nrows,
        ncols=case.grid.ncols,
        dx=case.grid.dx,
        duration=case.duration,
        output_interval=case.output_interval,
        source=case.source,
        licence=case.licence,
    )


def _data_home() -> Path | None:
    home = os.environ.get("FEV_DATA_HOME")
    return Path(home) if home and Path(home).is_dir() else None


@contextmanager
def _find(name: str, need_terrain: bool = True) -> Iterator[CaseFolder]:
    """The folder of a case by name, else by path."""
    plain = 0 < len(name) <= 100 and not set(name) & set("/\\\0") and name not in (".", "..")
    if plain and (EMBEDDED / name / CASE_FILE).is_file():
        root = EMBEDDED / name
        if name == malpasset.NAME and need_terrain:
            root = malpasset.data_folder()
        yield CaseFolder(EMBEDDED / name / CASE_FILE, root)
        return
    home = _data_home()
    candidates = [home / name, home / f"{name}{ARCHIVE_SUFFIX}"] if plain and home is not None else []
    candidates = [path for path in candidates if path.is_file() or (path / CASE_FILE).is_file()]
    path = candidates[0] if candidates else Path(name)
    try:
        absent = not name or "\0" in name or not path.exists()
    except OSError:
        absent = True
    if absent:
        known = ", ".join(list_cases())
        raise CaseError(f"There is no case '{name[:200]}'; {known}, or the path of a case, is allowed.")
    with open_case(path) as folder:
        yield folder
