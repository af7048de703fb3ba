"""A small case with one of each kind of forcing: a spring, a river, a sea, rain, and two breaches."""

from pathlib import Path

import numpy as np

DX = 10.0
ROWS, COLS = 40, 60
OUTPUT_INTERVAL = 10.0


def write_forced_basin(folder: Path, duration: float = 200.0, name: str = "basin", rain: bool = True) -> Path:
    """Write the case and give its folder."""
    folder.mkdir(parents=True, exist_ok=True)
    y, x = np.mgrid[0:ROWS, 0:COLS] * DX + 0.5 * DX
    bed = 2.0 + 0.002 * x + 0.3 * np.cos(y / 60.0)
    bed[:, 28:31] = 5.0  # a dike across the basin
    bed[:, 44:46] = 3.2  # a lower one behind it
    np.savez(folder / "bed.npz", bed=bed.astype(np.float32))
    falls = '[rain]\nseries = "rain.csv"\n' if rain else ""
    (folder / "rain.csv").write_text("time_s,rain_mm_h\n0,20\n100,40\n")
    (folder / "river.csv").write_text("time_s,discharge_m3_s\n0,0\n30,40\n200,60\n")
    (folder / "case.toml").write_text(
        f"""
[case]
name = "{name}"
title = "A basin for tests"
hypothetical = true
crs = "local"
source = "made by the tests"

[terrain]
dem = "bed.npz"
key = "bed"
cell_size = {DX}

[roughness]
manning_n = 0.03

[initial]
[[initial.level]]
level = 3.5
side_of_line = [[285.0, 0.0], [285.0, 400.0]]

[[source]]
id = "spring"
at = [105.0, 205.0]
radius = 12.0
discharge = 5.0

[[boundary]]
id = "river"
edge = "west"
from = 100.0
to = 300.0
kind = "discharge"
series = "river.csv"

[[boundary]]
id = "sea"
edge = "east"
kind = "stage"
level = 3.4
{falls}
[[breach]]
id = "dike"
line = [[295.0, 150.0], [295.0, 250.0]]
start_time = 60.0
duration = 40.0
bottom_level = 2.5
width_final = 60.0
across = 30.0

[[breach]]
id = "low"
line = [[450.0, 150.0], [450.0, 250.0]]
start = "overtopping"
duration = 40.0
bottom_level = 2.6
width_final = 60.0
across = 20.0

[run]
duration = {duration}
output_interval = {OUTPUT_INTERVAL}
""",
        encoding="utf-8",
    )
    return folder
