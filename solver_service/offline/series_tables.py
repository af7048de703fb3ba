"""Tables of what gauges and sections recorded, one line for each time and place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from solver_service.numerics import GaugeSeries
from solver_service.scenario import Case

GAUGE_COLUMNS = "time_s,gauge,depth_m,level_m,u_m_s,v_m_s"
SECTION_COLUMNS = "time_s,section,discharge_m3_s,wet_area_m2"

Curves = tuple[NDArray[np.float64], NDArray[np.float64]]


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


def section_discharge(case: Case, series: GaugeSeries) -> list[Curves]:
    """Discharge [m3/s], positive to the right of the line, and wet area [m2] of each section.

    Args:
        case: its sections' points stand in the series after its gauges.
        series: what the solver recorded.
    """
    found = []
    at = len(case.gauges)
    for section in case.sections:
        points = slice(at, at + section.x.size)
        at += section.x.size
        h = series.h[:, points].astype(np.float64)
        normal_speed = series.u[:, points] * section.normal_x + series.v[:, points] * section.normal_y
        found.append(((h * normal_speed) @ section.ds, h @ section.ds))
    return found


def write_sections(path: Path, case: Case, series: GaugeSeries) -> None:
    """Write discharge and wet area of each section.

    Raises:
        OSError: the file cannot be written.
    """
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write(SECTION_COLUMNS + "\n")
        for section, (discharge, area) in zip(case.sections, section_discharge(case, series), strict=True):
            name = quoted(section.id)
            rows = zip(series.times.tolist(), discharge.tolist(), area.tolist(), strict=True)
            file.writelines(f"{t:.10g},{name},{q:.4f},{a:.4f}\n" for t, q, a in rows)


def quoted(name: str) -> str:
    """A name as a cell of a CSV file."""
    if set(name) & set(',"\r\n'):
        return '"' + name.replace('"', '""') + '"'
    return name
