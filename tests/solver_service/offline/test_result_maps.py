from pathlib import Path

import numpy as np
import pytest
import rasterio

from solver_service.numerics import ShallowWaterSolver
from solver_service.offline.result_maps import arrival_name, write_maps
from solver_service.scenario import Case, load_case
from tests.solver_service.tiny_case import CASE, write_case

GROUND = '\n[infiltration]\nmodel = "constant"\nrate = 3600.0\n'


@pytest.fixture(scope="module")
def flood(tmp_path_factory: pytest.TempPathFactory) -> tuple[Case, ShallowWaterSolver, Path]:
    folder = tmp_path_factory.mktemp("maps")
    case = load_case(write_case(folder, CASE + "arrival_depths = [0.15, 1]\n" + GROUND))
    solver = ShallowWaterSolver(case.model, case.params, "cpu")
    solver.set_water(case.initial_h)
    solver.advance_to(case.duration)
    write_maps(folder, case, solver)
    return case, solver, folder


def read(folder: Path, name: str) -> np.ndarray:
    with rasterio.open(folder / f"{name}.tif") as image:
        return image.read(1)[::-1]


def test_every_class_has_its_arrival(flood: tuple[Case, ShallowWaterSolver, Path]) -> None:
    _, _, folder = flood

    first, shallow, deep = (read(folder, name) for name in ("arrival_time", "arrival_0_15m", "arrival_1m"))

    assert (~np.isnan(first)).sum() > (~np.isnan(shallow)).sum() > (~np.isnan(deep)).sum() > 0
    both = ~np.isnan(deep)
    assert (deep[both] >= shallow[both]).all()
    assert arrival_name(0.5) == "arrival_0_5m"


def test_time_of_maximum_and_wet_duration_lie_within_the_run(
    flood: tuple[Case, ShallowWaterSolver, Path],
) -> None:
    case, solver, folder = flood
    wet = solver.maxima().h > 1e-3

    for name in ("time_of_max", "wet_duration"):
        values = read(folder, name)
        assert np.isnan(values[~wet]).all()
        assert 0.0 <= values[wet].min() <= values[wet].max() <= case.duration
    assert read(folder, "wet_duration")[12, 2] == pytest.approx(case.duration)
    assert np.nanmax(read(folder, "rise_rate")) > 0.01


def test_infiltration_is_a_map_where_the_ground_took_water(
    flood: tuple[Case, ShallowWaterSolver, Path],
) -> None:
    case, solver, folder = flood

    taken = read(folder, "infiltration")

    # A rate of 3600 mm/h takes 1 mm a second.
    assert taken[12, 2] == pytest.approx(1e-3 * case.duration, rel=1e-3)
    assert np.nansum(taken, dtype=np.float64) * 100.0 == pytest.approx(solver.budget().infiltration, rel=1e-6)
    assert np.isnan(taken[0, -1])
