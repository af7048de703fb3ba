import math
from typing import Any

import msgspec
import pytest

from protocol import Edit, EditError, GridGeometry, check_edit, limits
from tests.protocol.edits.examples import area, line

GRID = GridGeometry(nrows=20, ncols=30, dx=2.0)
GOOD = line([(5.0, 7.0), (31.0, 15.0)], id="levee")


@pytest.mark.parametrize(
    "edit",
    [
        GOOD,
        line([(0.0, 0.0), (60.0, 40.0)]),
        line([(5.0, 7.0), (5.0, 7.0), (6.0, 9.0)]),
        line([(5.0, 7.0), (31.0, 15.0)], type="replace", level=3.0),
        area([(5.0, 5.0), (40.0, 7.0), (30.0, 33.0)]),
    ],
)
def test_a_good_edit_passes(edit: Edit) -> None:
    check_edit(edit, GRID)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"width": 0.0}, "width"),
        ({"width": -1.0}, "width"),
        ({"magnitude": 0.0}, "magnitude"),
        ({"magnitude": 1e9}, "magnitude"),
        ({"id": "a b"}, "id"),
        ({"vertices": ((5.0, 7.0),)}, "vertices"),
        ({"vertices": ((5.0, 7.0),) * (limits.MAX_VERTICES + 1)}, "vertices"),
        ({"vertices": ((5.0, 7.0), (61.0, 7.0))}, "vertex 1 .* outside the terrain"),
        ({"vertices": ((5.0, 7.0), (5.0, 7.0))}, "at one point"),
        ({"level": 1e6}, "level"),
        ({"operation": "explode"}, "operation"),
        ({"vertices": ((5.0, 7.0), (6.0,))}, "vertices"),
    ],
)
def test_a_bad_edit_is_refused_with_its_id_and_what_is_wrong(change: dict[str, Any], sentence: str) -> None:
    edit = msgspec.structs.replace(GOOD, **change)
    with pytest.raises(EditError, match=sentence) as caught:
        check_edit(edit, GRID)
    assert repr(edit.id) in str(caught.value)
    assert caught.value.code == "invalid_edit"


def test_an_area_between_cell_centres_is_refused() -> None:
    with pytest.raises(EditError, match="no cell centre"):
        check_edit(area([(10.1, 10.1), (10.2, 10.1), (10.2, 10.2)]), GRID)


@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_numbers_that_are_not_finite_cannot_even_be_written(number: float) -> None:
    with pytest.raises(ValueError, match="finite"):
        line([(5.0, number), (31.0, 15.0)])
    with pytest.raises(ValueError, match="finite"):
        line([(5.0, 7.0), (31.0, 15.0)], number)
