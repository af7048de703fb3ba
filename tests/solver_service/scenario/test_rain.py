from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import ServiceError
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY, loaded
from tests.solver_service.tiny_case import write_case


def test_rain_is_read_in_mm_an_hour(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[rain]\nseries = "rain.csv"\n')
    (tmp_path / "rain.csv").write_text("time_s,rain\n0,36\n600,0\n")

    rain = load_case(tmp_path).model.rain

    assert rain.times.tolist() == [0.0, 600.0]
    np.testing.assert_allclose(rain.rates.ravel(), [1e-5, 0.0])
    constant = loaded(tmp_path / "b", "\n[rain]\nrate = 36.0\n").model.rain
    np.testing.assert_allclose(constant.rates.ravel(), [1e-5])


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("rate = -1.0", "rate is -1.0"),
        ("", "either 'rate' in mm/h or 'series'"),
        ('series = "rain.nc"', "does not exist"),
        ('series = "none.csv"', "does not exist"),
    ],
)
def test_bad_rain_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(ServiceError, match=message):
        loaded(tmp_path, f"\n[rain]\n{keys}\n")


def test_the_unit_is_declared_by_the_case_or_the_column(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[rain]\nseries = "rain.csv"\n')
    (tmp_path / "rain.csv").write_text("time_s,rain_mm_day\n0,864\n")
    np.testing.assert_allclose(load_case(tmp_path).model.rain.rates, 1e-5)

    daily = loaded(tmp_path / "b", '\n[rain]\nrate = 864.0\nunit = "mm/day"\n').model.rain
    np.testing.assert_allclose(daily.rates, 1e-5)

    write_case(tmp_path, DRY + '\n[rain]\nseries = "rain.csv"\nunit = "mm/h"\n')
    with pytest.raises(ServiceError, match="'rain_mm_day' is in mm/day, but the case says unit = 'mm/h'"):
        load_case(tmp_path)


def test_rain_may_hold_from_time_to_time(tmp_path: Path) -> None:
    assert loaded(tmp_path, "\n[rain]\nrate = 5.0\n").model.rain.interpolation == "linear"
    step = loaded(tmp_path, '\n[rain]\nrate = 5.0\ninterpolation = "step"\n')
    assert step.model.rain.interpolation == "step"


@pytest.mark.parametrize("rate", [501.0, 9999.0])
def test_rain_that_no_sky_has_brought_is_told(tmp_path: Path, rate: float) -> None:
    (warning,) = loaded(tmp_path, f"\n[rain]\nrate = {rate}\n").warnings

    assert f"a rain of {rate:g} mm/h is odd" in warning


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("rate = 10001.0", "rate is 10001.0; a rain in mm/h from 0 to 10000"),
        ('rate = 1.0\nunit = "m/s"', "rate is 1.0; a rain in m/s from 0 to 0.00277778"),
        ('rate = 5.0\nunit = "in/h"', "unit is 'in/h'; 'mm/h', 'mm/day', 'm/s' is allowed"),
        ('rate = 5.0\nkey = "rain"', "key is 'rain'; it means something only beside 'series'"),
        ('series = "rain.csv"\nrow0 = "north"', "row0 is 'north'; it is allowed where series brings rasters"),
    ],
)
def test_bad_units_and_idle_keys_are_told(tmp_path: Path, keys: str, message: str) -> None:
    write_case(tmp_path, f"{DRY}\n[rain]\n{keys}\n")
    (tmp_path / "rain.csv").write_text("time_s,rain\n0,5\n")

    with pytest.raises(ServiceError, match=message):
        load_case(tmp_path)
