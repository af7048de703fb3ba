"""Tables of what gauges and sections recorded, one line for each time and place."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from solver_service.numerics import GaugeSeries
from solver_service.numerics.section import SectionSeries
from solver_service.scenario import Case

GAUGE_COLUMNS = "time_s,gauge,depth_m,level_m,u_m_s,v_m_s"
SECTION_COLUMNS = "time_s,section,discharge_m3_s,wet_area_m2,volume_m3"


def write_gauges(path: Path, case: Case, series: GaugeSeries) -> None:
    """Write depth, real level and velocity of each gauge; a dry gauge's level is its bed.

    Raises:
        OSError: the file cannot be written.
    """
    offset = case.grid.datum_offset
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write(GAUGE_COLUMNS + "\n")
        for column, gauge in enumerate(case.gauges):
            name = quoted(gauge.id)
            rows = zip(
                series.times.tolist(),
                series.h[:, column].tolist(),
                (series.eta[:, column].astype(np.float64) + offset).tolist(),
                series.u[:, column].tolist(),
                series.v[:, column].tolist(),
                strict=True,
            )
            file.writelines(f"{t:.10g},{name},{h:.4f},{z:.4f},{u:.4f},{v:.4f}\n" for t, h, z, u, v in rows)


def write_sections(path: Path, ids: Sequence[str], series: SectionSeries) -> None:
    """Write discharge and volume, positive to the right of the line, and wet area of each section.

    Args:
        path: the file.
        ids: names of the sections, which stand first in the series.
        series: what the solver recorded.

    Raises:
        OSError: the file cannot be written.
    """
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write(SECTION_COLUMNS + "\n")
        for column, name in enumerate(map(quoted, ids)):
            curves = (series.discharge[:, column], series.area[:, column], series.volume[:, column])
            rows = zip(series.times.tolist(), *(curve.tolist() for curve in curves), strict=True)
            file.writelines(f"{t:.10g},{name},{q:.4f},{a:.4f},{v:.8g}\n" for t, q, a, v in rows)


def quoted(name: str) -> str:
    """A name as a cell of a CSV file."""
    if set(name) & set(',"\r\n'):
        return '"' + name.replace('"', '""') + '"'
    return name
