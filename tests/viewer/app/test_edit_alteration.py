import msgspec
import pytest

import protocol
from tests.viewer.tiny_service import GRID
from viewer.app.edit_alteration import altered, moved, renamed, settings_of, with_vertex
from viewer.commands import ChangeEdit, ChangeEditSettings, CommandError
from viewer.view_status import EditSettings

LINE = protocol.EditLine(
    "line",
    ((1100.0, 2100.0), (1300.0, 2200.0)),
    12.0,
    protocol.Operation.raise_,
    protocol.EditType.modulate,
    3.0,
    name="Levee",
)
CREST = msgspec.structs.replace(LINE, type=protocol.EditType.replace, reference_z=(10.0, 30.0))
AREA = protocol.EditArea(
    "area",
    ((1100.0, 2100.0), (1200.0, 2100.0), (1200.0, 2200.0)),
    protocol.Operation.lower,
    protocol.EditType.replace,
    3.0,
    level=51.5,
)


def slope(x: float, _y: float) -> float:
    return 0.1 * (x - 1000.0)


def test_an_edit_moves_as_a_whole_and_keeps_all_else() -> None:
    there = moved(LINE, 50.0, -25.0, GRID, slope)
    assert there == msgspec.structs.replace(LINE, vertices=((1150.0, 2075.0), (1350.0, 2175.0)))
    assert moved(AREA, 10.0, 0.0, GRID, slope).level == 51.5


def test_a_crest_above_the_ground_takes_the_ground_where_it_goes() -> None:
    assert moved(CREST, 50.0, 0.0, GRID, slope).reference_z == pytest.approx((15.0, 35.0))
    assert with_vertex(CREST, 1, (1500.0, 2200.0), GRID, slope).reference_z == pytest.approx((10.0, 50.0))
    assert moved(AREA, 50.0, 0.0, GRID, slope).reference_z is None


@pytest.mark.parametrize("by", [(1e9, 1e9), (-1e9, -1e9), (0.1, 1e6)])
def test_an_edit_is_moved_no_farther_than_the_terrain_goes(by: tuple[float, float]) -> None:
    there = moved(LINE, *by, GRID, slope)
    protocol.check_edit(there, GRID)
    shape = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(LINE.vertices, there.vertices, strict=True)]
    assert shape[0] == pytest.approx(shape[1])


def test_a_vertex_stays_on_the_terrain_and_must_be_one_of_the_edit() -> None:
    there = with_vertex(LINE, 0, (-1e9, 2100.0), GRID, slope)
    assert there.vertices == ((GRID.extent[0], 2100.0), (1300.0, 2200.0))
    for number in (-1, 2):
        with pytest.raises(CommandError, match=f"vertex {number} "):
            with_vertex(LINE, number, (1100.0, 2100.0), GRID, slope)


def test_an_edit_is_renamed() -> None:
    assert renamed(LINE, "  New name ").name == "New name"
    assert len(renamed(LINE, "x" * 300).name) == 100


def test_the_numbers_named_change_and_the_others_stay() -> None:
    after = altered(LINE, ChangeEdit(width=20.0, operation="lower"), slope)
    assert after == msgspec.structs.replace(LINE, width=20.0, operation=protocol.Operation.lower)
    assert altered(AREA, ChangeEditSettings(magnitude=9.0), slope).magnitude == 9.0


def test_an_edit_that_becomes_a_crest_takes_the_ground_and_one_that_ceases_to_be_one_drops_it() -> None:
    crest = altered(LINE, ChangeEditSettings(type="replace"), slope)
    assert crest.reference_z == pytest.approx((10.0, 30.0))
    assert altered(CREST, ChangeEditSettings(magnitude=5.0), slope).reference_z == CREST.reference_z
    level = altered(CREST, ChangeEditSettings(level=60.0, at_level=True), slope)
    assert (level.level, level.reference_z) == (60.0, None)
    plain = altered(level, ChangeEditSettings(type="modulate"), slope)
    assert (plain.level, plain.reference_z) == (None, None)
    assert altered(AREA, ChangeEditSettings(at_level=False), slope).reference_z == pytest.approx(
        (10.0, 20.0, 20.0)
    )


def test_the_settings_of_an_edit_are_its_numbers() -> None:
    assert settings_of(LINE) == EditSettings(12.0, 3.0, "raise", "modulate")
    assert settings_of(AREA) == EditSettings(EditSettings().width, 3.0, "lower", "replace", 51.5, True)
    assert altered(AREA, ChangeEditSettings(), slope) == AREA
    assert altered(CREST, ChangeEditSettings(), slope) == CREST
