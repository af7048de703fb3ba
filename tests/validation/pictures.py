"""Pictures that the validation tests describe; ``report.py`` draws them for ``docs/validation.md``."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import ArrayLike

from tests.validation.runs import State

STYLES = {
    "bed": {"color": "#7a6a55", "lw": 1.0},
    "fine": {"color": "#8fb3d1", "lw": 1.6},
    "exact": {"color": "black", "lw": 1.0},
    "computed": {"color": "#0b62a8", "lw": 0.0, "marker": "o", "ms": 2.6},
    "other": {"color": "#c2571a", "lw": 0.0, "marker": "x", "ms": 3.2, "mew": 0.8},
}
LABELS = {kind: kind for kind in STYLES} | {"fine": "fine grid", "other": "published scheme"}


@dataclass(frozen=True)
class Line:
    """One line of a panel; ``kind`` is a key of STYLES."""

    kind: str
    x: ArrayLike
    y: ArrayLike
    label: str = ""


@dataclass(frozen=True)
class Panel:
    """One diagram."""

    title: str
    across: str
    up: str
    lines: tuple[Line, ...]
    log: bool = False


@dataclass(frozen=True)
class Picture:
    """Diagrams of one case, side by side, kept as ``name``.png."""

    case: str
    name: str
    panels: tuple[Panel, ...]


def profiles(x: ArrayLike, exact: State, computed: State, published: State) -> tuple[Panel, Panel]:
    """Depth and velocity along x."""

    def lines(k: int) -> tuple[Line, ...]:
        every = slice(None, None, 2)
        return (
            Line("exact", x, exact[k]),
            Line("other", x[every], published[k][every]),
            Line("computed", x[every], computed[k][every]),
        )

    return Panel("depth", "x [m]", "h [m]", lines(0)), Panel("velocity", "x [m]", "u [m/s]", lines(1))


PICTURES = pytest.StashKey[list[Picture]]()


def draw(picture: Picture, folder: Path) -> Path:
    """Draw a picture into a folder and return its file."""
    from matplotlib.figure import Figure  # drawn by the report alone

    count = len(picture.panels)
    columns = min(count, 3)
    rows = -(-count // columns)
    figure = Figure(figsize=(3.0 * columns + 0.4, 2.2 * rows + 0.35), dpi=100, layout="constrained")
    for k, panel in enumerate(picture.panels):
        axes = figure.add_subplot(rows, columns, k + 1)
        for line in panel.lines:
            label = line.label or LABELS[line.kind]
            axes.plot(np.asarray(line.x), np.asarray(line.y), label=label, **STYLES[line.kind])
            if line.kind == "bed":
                axes.fill_between(line.x, line.y, min(line.y), color="#e8e0d2", lw=0.0)
        axes.set_title(panel.title, fontsize=8)
        axes.set_xlabel(panel.across, fontsize=7)
        axes.set_ylabel(panel.up, fontsize=7)
        axes.tick_params(labelsize=7)
        if panel.log:
            axes.loglog()
            axes.set_xticks(panel.lines[0].x, [str(x) for x in panel.lines[0].x])
            axes.minorticks_off()
        else:
            axes.margins(x=0.01)
    handles = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    figure.legend(
        handles.values(), handles.keys(), loc="outside lower center", ncols=6, fontsize=7, frameon=False
    )
    path = folder / f"{picture.name}.png"
    figure.savefig(path, metadata={"Software": None})
    return path
