import json
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import rasterio
import zarr

from solver_service.errors import DeviceError, RunError
from solver_service.offline import OfflineOptions, run_case
from solver_service.scenario import Case, load_case
from solver_service.terrain import read_dem
from tests.solver_service.tiny_case import CASE, GAUGES, rows_of, write_case

CPU = OfflineOptions(device="cpu", threads=1)


def read_values(path: Path) -> np.ndarray:
    with rasterio.open(path) as image:
        return image.read(1)[::-1]


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    return load_case(write_case(tmp_path_factory.mktemp("case"), CASE + GAUGES))


@pytest.fixture(scope="module")
def out(case: Case, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results") / "out"
    run_case(case, OfflineOptions(out=folder, device="cpu", netcdf=True, zarr=True))
    return folder


def test_every_result_is_there_and_nothing_else(out: Path) -> None:
    assert sorted(path.name for path in out.iterdir()) == [
        "arrival_time.tif",
        "gauges.csv",
        "max_depth.tif",
        "max_hazard.tif",
        "max_speed.tif",
        "rise_rate.tif",
        "sections.csv",
        "structures.csv",
        "summary.json",
        "time_of_max.tif",
        "timesteps.nc",
        "timesteps.zarr",
        "wet_duration.tif",
    ]
    assert [path.name for path in out.parent.iterdir()] == ["out"]


def test_the_summary_keeps_the_contract(case: Case, out: Path) -> None:
    summary = json.loads((out / "summary.json").read_text())

    contract = "case cells steps sim_time_s wall_s cell_steps_per_s speed_x_real_time volume_error_relative"
    assert set(f"{contract} max_speed_m_s device".split()) <= set(summary)
    assert (summary["case"], summary["cells"], summary["sim_time_s"]) == ("tiny", 960, 20.0)
    assert summary["steps"] > 20
    assert abs(summary["volume_error_relative"]) < 1e-6
    assert summary["cell_steps_per_s"] == pytest.approx(960 * summary["steps"] / summary["wall_s"])
    assert summary["water_budget_m3"]["initial"] == pytest.approx(case.initial_h.sum() * 100.0, rel=1e-6)
    assert 1.0 < summary["max_speed_m_s"] < 20.0


def test_maps_agree_with_the_frames(case: Case, out: Path) -> None:
    depth = read_dem(out / "max_depth.tif")
    arrival = read_values(out / "arrival_time.tif")
    with netCDF4.Dataset(out / "timesteps.nc") as file:
        frames = np.asarray(file["depth"][:])
        times = np.asarray(file["time"][:])

    assert depth.bounds == case.grid.extent
    assert times.tolist() == [0.0, 5.0, 10.0, 15.0, 20.0]
    np.testing.assert_array_equal(frames[0], case.initial_h)
    highest = np.nan_to_num(depth.values, nan=0.0)
    assert (highest >= frames.max(axis=0) - 2e-3).all()
    reached = ~np.isnan(arrival)
    for time, h in zip(times, frames, strict=True):
        assert (arrival[reached & (h > 0.02)] <= time).all()
    assert reached[:, 15:].any()


def test_gauges_and_sections_follow_the_flood(case: Case, out: Path) -> None:
    gauges = rows_of(out / "gauges.csv")
    sections = rows_of(out / "sections.csv")

    assert len(gauges) == 2 * 21
    lower = [float(row["depth_m"]) for row in gauges if row["gauge"] == "lower"]
    assert lower[0] == 0.0
    assert lower[-1] > 0.1
    start = next(row for row in gauges if row["gauge"] == "upper")
    assert float(start["level_m"]) == pytest.approx(306.0, abs=1e-3)
    # The line runs south, so water that goes east leaves to its left.
    assert float(sections[0]["discharge_m3_s"]) == 0.0
    assert min(float(row["discharge_m3_s"]) for row in sections) < -50.0


def test_what_passes_the_dam_arrives_below_it(case: Case, out: Path) -> None:
    rows = rows_of(out / "sections.csv")
    passed = -float(rows[-1]["volume_m3"])
    with netCDF4.Dataset(out / "timesteps.nc") as file:
        below = float(file["depth"][-1, :, 10:].sum()) * 100.0
    budget = json.loads((out / "summary.json").read_text())

    assert passed == pytest.approx(below + budget["water_budget_m3"]["outflow"], rel=1e-4)


def test_zarr_and_netcdf_hold_the_same_bits(out: Path) -> None:
    with netCDF4.Dataset(out / "timesteps.nc") as file:
        np.testing.assert_array_equal(
            zarr.open_group(str(out / "timesteps.zarr"), mode="r")["depth"][:], file["depth"][:]
        )


def test_until_cuts_the_last_frame_and_progress_is_told(case: Case) -> None:
    told: list[tuple[float, float]] = []

    summary = run_case(case, OfflineOptions(until=12.0, device="cpu"), lambda *at: told.append(at))

    assert told == [(5.0, 12.0), (10.0, 12.0), (12.0, 12.0)]
    assert summary["sim_time_s"] == 12.0


def test_the_run_is_the_same_on_one_thread_and_two(case: Case) -> None:
    one = run_case(case, CPU)
    two = run_case(case, OfflineOptions(device="cpu", threads=2))

    for name in ("steps", "water_budget_m3", "max_depth_m", "max_speed_m_s"):
        assert one[name] == two[name]


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        (OfflineOptions(until=0.0), RunError, "until is 0 s; a time above 0"),
        (OfflineOptions(until=float("nan")), RunError, "until is nan s"),
        (OfflineOptions(threads=0), RunError, "threads is 0; 1 or more"),
        (OfflineOptions(netcdf=True), RunError, "need an output folder; give --out"),
        (OfflineOptions(device="cuda:17"), DeviceError, "'cuda:17' is not there; available are auto, cpu"),
    ],
)
def test_a_bad_option_is_told(
    case: Case, options: OfflineOptions, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        run_case(case, options)


def test_a_run_that_cannot_start_leaves_no_folder(case: Case, tmp_path: Path) -> None:
    with pytest.raises(DeviceError):
        run_case(case, OfflineOptions(out=tmp_path / "out", device="cuda:17"))

    assert list(tmp_path.iterdir()) == []


def test_a_run_that_is_interrupted_leaves_no_folder(case: Case, tmp_path: Path) -> None:
    def interrupt(time: float, until: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_case(case, OfflineOptions(out=tmp_path / "out", device="cpu", netcdf=True, zarr=True), interrupt)

    assert list(tmp_path.iterdir()) == []
