from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import ServiceError
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY, loaded
from tests.solver_service.tiny_case import COLS, ROWS, write_case

MM_H = 1e-3 / 3600.0
WEST = "polygon = [[1000, 2000], [1100, 2000], [1100, 2240], [1000, 2240]]"
CONSTANT = '\n[infiltration]\nmodel = "constant"\nrate = 36.0\n'
HORTON = '\n[infiltration]\nmodel = "horton"\nrate_initial = 90.0\nrate_final = 9.0\ndecay = 3.6\n'
GREEN_AMPT = '\n[infiltration]\nmodel = "green_ampt"\nconductivity = 10.9\nsuction = 110.0\ndeficit = 0.3\n'


def test_units_become_si(tmp_path: Path) -> None:
    constant = loaded(tmp_path, CONSTANT + "capacity = 50.0\n").model.infiltration
    horton = loaded(tmp_path, HORTON).model.infiltration
    green_ampt = loaded(tmp_path, GREEN_AMPT).model.infiltration

    assert (constant.kind, constant.zone) == ("constant", None)
    assert {name: value.tolist() for name, value in constant.parameters.items()} == {
        "rate": [pytest.approx(1e-5)],
        "capacity": [pytest.approx(0.05)],
    }
    assert horton.parameters["f0"].tolist() == [pytest.approx(90.0 * MM_H)]
    assert horton.parameters["k"].tolist() == [pytest.approx(1e-3)]
    assert green_ampt.parameters["suction"].tolist() == [pytest.approx(0.11)]
    assert green_ampt.parameters["deficit"].tolist() == [0.3]
    assert loaded(tmp_path, "").model.infiltration is None


def test_later_zones_win(tmp_path: Path) -> None:
    inner = "polygon = [[1000, 2000], [1050, 2000], [1050, 2240], [1000, 2240]]"
    zones = f"\n[[infiltration.zone]]\nrate = 0.0\n{WEST}\n[[infiltration.zone]]\nrate = 7.2\n{inner}\n"

    found = loaded(tmp_path, CONSTANT + zones).model.infiltration

    rate = found.parameters["rate"][found.zone]
    np.testing.assert_allclose(rate[:, :5], 7.2 * MM_H)
    assert (rate[:, 5:10] == 0.0).all()
    np.testing.assert_allclose(rate[:, 10:], 36.0 * MM_H)


def test_soils_come_by_class_and_zones_lie_over_them(tmp_path: Path) -> None:
    soil = '\n[infiltration]\nmodel = "green_ampt"\nclasses = "soil.npz"\ntable = "soil.csv"\n'
    roof = f"\n[[infiltration.zone]]\nconductivity = 0\nsuction = 0\ndeficit = 0\n{WEST}\n"
    write_case(tmp_path, DRY + soil + roof)
    classes = np.full((ROWS, COLS), 3)
    classes[:12] = 8
    np.savez(tmp_path / "soil.npz", classes=classes)
    (tmp_path / "soil.csv").write_text(
        "class,conductivity,suction,deficit\n3,3.4,88.9,0.4\n8,117.8,49.5,0.42\n"
    )

    found = load_case(tmp_path).model.infiltration

    conductivity = found.parameters["conductivity"][found.zone]
    np.testing.assert_allclose(conductivity[:12, 10:], 117.8 * MM_H)
    np.testing.assert_allclose(conductivity[12:, 10:], 3.4 * MM_H)
    assert (conductivity[:, :10] == 0.0).all()


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("", "model is missing; 'constant', 'horton', 'green_ampt' is allowed"),
        ('model = "scs"', "model is 'scs'"),
        ('model = "constant"', "rate is missing; a rate in mm/h from 0 to 10000"),
        ('model = "constant"\nrate = -1', "rate is -1"),
        (
            'model = "constant"\nrate = 1\nsuction = 3',
            "suction is 3; rate, capacity are the keys",
        ),
        (
            'model = "horton"\nrate_initial = 3\nrate_final = 9\ndecay = 1',
            "a rate_final above",
        ),
        (
            'model = "green_ampt"\nconductivity = 3\nsuction = 9\ndeficit = 30',
            "deficit is 30; a moist",
        ),
        ('model = "constant"\nclasses = "s.tif"\nrate = 1', "rate is 1; it is not allowed"),
        (
            'model = "constant"\nrate = 1\ntable = "s.csv"',
            "table is 's.csv'; it means something",
        ),
        (
            f'model = "constant"\nrate = 1\n[[infiltration.zone]]\n{WEST}',
            r"zone\]\] number 1 rate is missing",
        ),
        (
            f'model = "constant"\nrate = 1\n[[infiltration.zone]]\ndecay = 1\n{WEST}',
            "number 1 decay is 1",
        ),
    ],
)
def test_bad_infiltration_is_told(tmp_path: Path, table: str, message: str) -> None:
    with pytest.raises(ServiceError, match=message) as caught:
        loaded(tmp_path, f"\n[infiltration]\n{table}\n")

    assert str(caught.value).startswith("case.toml: ")
