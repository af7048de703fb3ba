import msgspec
import pytest

from protocol import EditArea, EditLine, EditType, Operation
from solver_service.runs.edit_blobs import pack_edit, pack_edits, unpack_edit, unpack_edits

LEVEE = EditLine(
    "levee", ((0.0, 0.0), (30.0, 40.0)), 5.0, Operation.raise_, EditType.replace, 2.0, level=101.5
)
PIT = EditArea("pit", ((0.0, 0.0), (30.0, 0.0), (30.0, 40.0)), Operation.lower, EditType.modulate, 1.0)


@pytest.mark.parametrize("edit", [LEVEE, PIT], ids=["line", "area"])
def test_an_edit_comes_back_from_the_store_as_it_was(edit: EditLine | EditArea) -> None:
    assert unpack_edit(pack_edit(edit)) == edit


def test_a_list_of_edits_keeps_its_order() -> None:
    assert unpack_edits(pack_edits((PIT, LEVEE))) == (PIT, LEVEE)


def test_bytes_that_are_no_edit_are_refused() -> None:
    with pytest.raises(msgspec.ValidationError):
        unpack_edit(msgspec.msgpack.encode({"kind": "circle", "id": "x"}))
