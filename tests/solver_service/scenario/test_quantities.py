import pytest

from solver_service.scenario.quantities import DISCHARGE, LEVEL, RAIN, SPELLINGS, unit_of_column


@pytest.mark.parametrize(
    ("column", "unit"),
    [
        ("discharge", None),
        ("discharge_m3_s", "m3/s"),
        ("Q_cfs", "ft3/s"),
        ("rain_mm_per_hour", "mm/h"),
        ("rain [mm/hr]", "mm/h"),
        ("rain (furlongs)", "furlongs"),
        ("level_m", "m"),
        ("stage_ft", "ft"),
        ("m", None),
        ("storm", None),
        ("rain_at_s", None),
    ],
)
def test_the_name_of_a_column_may_declare_its_unit(column: str, unit: str | None) -> None:
    assert unit_of_column(column) == unit


def test_every_unit_of_a_quantity_has_a_spelling_that_means_itself() -> None:
    for quantity in (DISCHARGE, LEVEL, RAIN):
        assert all(SPELLINGS[unit] == unit for unit in quantity.units)
        assert quantity.low < quantity.odd <= quantity.high


def test_units_are_what_their_names_say() -> None:
    assert RAIN.units["mm/h"] * 3600.0 == pytest.approx(1e-3)
    assert RAIN.units["mm/day"] * 24.0 == pytest.approx(RAIN.units["mm/h"])
    assert (DISCHARGE.units["l/s"], LEVEL.units["cm"]) == (1e-3, 1e-2)
    assert RAIN.spellings("mm/h")[0] == ""
    assert RAIN.spellings("mm/h")[-1] == "mm/h"
    assert "mm/hr" in RAIN.spellings("mm/h")
