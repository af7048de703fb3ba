import math
from typing import ClassVar

import msgspec
import numpy as np
import pytest

from protocol import AppendEdit, Credit, RunChanged
from protocol.fields import WireStruct, all_finite, plain, snake_case


class Probe(WireStruct, frozen=True):
    value: float
    pairs: tuple[tuple[float, float], ...] = ()
    table: dict[str, float] = msgspec.field(default_factory=dict)


@pytest.mark.parametrize(
    ("kind", "op"), [(AppendEdit, "append_edit"), (Credit, "credit"), (RunChanged, "run_changed")]
)
def test_an_operation_is_the_class_name_in_snake_case(kind: type, op: str) -> None:
    assert snake_case(kind.__name__) == kind.__struct_config__.tag == op


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_not_finite_is_refused_wherever_it_hides(number: float) -> None:
    with pytest.raises(ValueError, match="value"):
        Probe(number)
    with pytest.raises(ValueError, match="pairs"):
        Probe(0.0, ((1.0, 2.0), (3.0, number)))
    with pytest.raises(ValueError, match="table"):
        Probe(0.0, (), {"a": number})
    assert not all_finite([0.0, {"a": (number,)}])


def test_whole_numbers_and_text_are_finite() -> None:
    assert all_finite([10**400, "nan", None, True, {"inf": b""}])


def test_numpy_scalars_become_plain_numbers() -> None:
    value = plain(Probe(np.float32(0.5)))["value"]
    assert (value, type(value)) == (0.5, float)


def test_other_objects_are_refused() -> None:
    with pytest.raises(TypeError, match="complex"):
        plain(Probe(1j))  # type: ignore[arg-type]


class Newer(WireStruct, frozen=True):
    left_out: ClassVar[tuple[str, ...]] = ("label", "cells")
    value: float
    label: str = ""
    cells: tuple[int, ...] = ()
    plain: bool = False


class Holder(WireStruct, frozen=True):
    one: Newer
    many: tuple[Newer, ...] = ()


def test_a_field_that_came_later_is_left_out_while_it_has_its_default() -> None:
    assert plain(Newer(1.0)) == {"value": 1.0, "plain": False}
    assert plain(Newer(1.0, "a")) == {"value": 1.0, "label": "a", "plain": False}
    assert list(plain(Newer(1.0, "a", (2,)))) == ["value", "label", "cells", "plain"]


def test_later_fields_are_left_out_of_records_within_records() -> None:
    built = plain(Holder(Newer(1.0), (Newer(2.0), Newer(3.0, "b"))))
    assert built["one"] == {"value": 1.0, "plain": False}
    assert [sorted(each) for each in built["many"]] == [["plain", "value"], ["label", "plain", "value"]]


def test_a_record_without_its_later_fields_is_read_with_the_defaults() -> None:
    assert msgspec.convert(plain(Newer(1.0)), Newer) == Newer(1.0)
