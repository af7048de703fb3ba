from typing import Any

import msgspec
import pytest

from protocol import AppendEdit, EditArea, EditLine, EditType, Operation, pack, unpack_client
from tests.protocol.edits.examples import area, line

AB = [(0.0, 0.0), (1.0, 1.0)]


def test_the_signs_of_the_operations() -> None:
    assert (Operation.raise_.sign, Operation.lower.sign) == (1, -1)


def test_names_on_the_wire() -> None:
    assert [str(each) for each in Operation] == ["raise", "lower"]
    assert [str(each) for each in EditType] == ["modulate", "replace"]


@pytest.mark.parametrize(("edit", "kind"), [(line(AB), "line"), (area([*AB, (0.0, 1.0)]), "area")])
def test_an_edit_tells_its_kind_and_comes_back_as_it(edit: EditLine | EditArea, kind: str) -> None:
    assert msgspec.to_builtins(edit)["kind"] == kind
    message = unpack_client(pack(AppendEdit(1, "r", edit)))
    assert isinstance(message, AppendEdit)
    assert message.edit == edit


@pytest.mark.parametrize("reference_z", [(), (1.0,), (1.0, 2.0, 3.0)])
def test_a_reference_has_one_value_for_each_vertex(reference_z: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="reference_z"):
        line(AB, reference_z=reference_z)


@pytest.mark.parametrize("make", [lambda **k: line(AB, **k), lambda **k: area([*AB, (0.0, 1.0)], **k)])
def test_replace_needs_a_level_or_a_reference(make: Any) -> None:
    with pytest.raises(ValueError, match="'level' or 'reference_z'"):
        make(type="replace")
    assert make(type="replace", level=5.0).level == 5.0


def test_edits_are_values() -> None:
    assert line(AB) == line(AB)
    assert len({line(AB), line(AB), line(AB, 3.0)}) == 2
    with pytest.raises(AttributeError):
        line(AB).width = 3.0  # type: ignore[misc]
