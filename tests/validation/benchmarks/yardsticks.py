"""Run ANUGA on the benchmarks: ``python -m tests.validation.benchmarks.yardsticks``.

ANUGA is installed into an environment of its own, as `bench peers` does; the three runs take about a quarter
of an hour on one core. `FEV_DATA_HOME` names the folder of the data.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

from bench.peers.environments import PEERS, ROOT, python_of
from tests.validation.benchmarks import test_ea4, test_isolated_building, test_monai
from tests.validation.benchmarks.case_folders import Flood

NOTHING = {"forcing": "", "times": [0.0], "values": [0.0], "open_edges": False}


def anuga(folder: Path, flood: Flood, **forcing) -> dict[str, np.ndarray]:
    """Records at the gauges of a case by ANUGA."""
    case = flood.case
    given = {
        "bed": case.z_b,
        "depth": case.initial_h,
        "manning_n": float(np.asarray(case.model.manning_n).mean()),
        "dx": case.model.dx,
        "gauges": [(gauge.x - case.grid.x0, gauge.y - case.grid.y0) for gauge in case.gauges],
        "duration": case.duration,
        "interval": case.params.gauge_interval,
        "depth_dry": case.params.depth_dry,
    }
    np.savez(folder / "given.npz", **given, **(NOTHING | forcing))
    (peer,) = (peer for peer in PEERS if peer.script == "anuga")
    command = [python_of(peer), "-m", "bench.peers.run_anuga_benchmark", "given.npz", "found.npz"]
    subprocess.run(command, cwd=folder, env={"PYTHONPATH": str(ROOT)}, check=True, capture_output=True)
    with np.load(folder / "found.npz") as found:
        return dict(found)


def series(path: Path) -> dict[str, np.ndarray]:
    """Times and values of a series of the case."""
    times, values = np.loadtxt(path, delimiter=",", skiprows=1).T
    return {"times": times, "values": values}


def isolated_building(folder: Path) -> None:
    """RMSE of the windows and arrivals."""
    flood = Flood(folder, test_isolated_building.build(folder))
    found = anuga(folder, flood)
    flood.times = found["times"]
    for k, gauge in enumerate(flood.case.gauges):
        flood.h = {gauge.id: found["h"][:, k]}
        error = test_isolated_building.rmse(test_isolated_building.windows(flood, gauge.id), gauge.id)
        arrival = flood.arrival(gauge.id, 0.021)
        print(f"isolated building {gauge.id}: RMSE {error:.4f} m, arrival {arrival:.2f} s")


def monai(folder: Path) -> None:
    """RMSE of the levels."""
    flood = Flood(folder, test_monai.build(folder))
    found = anuga(folder, flood, forcing="stage", **series(folder / "wave.csv"))
    flood.times = found["times"]
    for k, gauge in enumerate(flood.case.gauges):
        flood.level = {gauge.id: found["level"][:, k]}
        off = test_monai.computed(flood, gauge.id) - test_monai.measured(gauge.id)[1]
        print(f"Monai {gauge.id}: RMSE {np.sqrt(np.mean(off**2)):.5f} m")


def floodplain(folder: Path) -> None:
    """Arrivals, highest depths and speeds."""
    flood = Flood(folder, test_ea4.build(folder))
    inlet = {"forcing": "discharge", "rectangle": [(0.0, 990.0), (20.0, 1010.0)], "open_edges": True}
    found = anuga(folder, flood, **inlet, **series(folder / "inflow.csv"))
    flood.times = found["times"]
    for k, gauge in enumerate(flood.case.gauges):
        flood.h = {gauge.id: found["h"][:, k]}
        arrivals = [flood.arrival(gauge.id, depth) for depth in (0.05, 0.15)]
        highest, fastest = found["h"][:, k].max(), found["speed"][:, k].max()
        print(f"EA test 4 {gauge.id}: arrivals {arrivals} s, {highest:.3f} m, {fastest:.3f} m/s")


if __name__ == "__main__":
    for benchmark in (isolated_building, monai, floodplain):
        with tempfile.TemporaryDirectory() as scratch:
            benchmark(Path(scratch))
