import protocol
from tests.viewer.tiny_service import GRID
from viewer.app.edit_selection import EditSelection, edit_at


def line(name: str, y: float, width: float = 20.0) -> protocol.EditLine:
    return protocol.EditLine(
        name,
        ((1100.0, y), (1500.0, y)),
        width,
        protocol.Operation.raise_,
        protocol.EditType.modulate,
        3.0,
    )


AREA = protocol.EditArea(
    "area",
    ((1200.0, 2300.0), (1400.0, 2300.0), (1400.0, 2500.0), (1200.0, 2500.0)),
    protocol.Operation.lower,
    protocol.EditType.modulate,
    3.0,
)
EDITS = (line("south", 2100.0), AREA, line("across", 2400.0))


def flat(_x: float, _y: float) -> float:
    return 0.0


def grab(selection: EditSelection, x: float, y: float, reach: float = 5.0) -> None:
    selection.grab(EDITS, (x, y), reach, lambda _name: flat)


def test_an_edit_is_found_on_its_ground_or_near_it() -> None:
    def found(x: float, y: float, reach: float) -> str | None:
        edit = edit_at(EDITS, (x, y), reach)
        return None if edit is None else edit.id

    assert found(1300.0, 2109.0, 0.0) == "south"
    assert found(1300.0, 2112.0, 0.0) is None
    assert found(1300.0, 2112.0, 3.0) == "south"
    assert found(1300.0, 2320.0, 0.0) == "area"
    assert found(1300.0, 2395.0, 0.0) == "across"  # the newer of two on whose ground it is
    assert found(1190.0, 2350.0, 12.0) == "area"
    assert found(1000.0, 2000.0, 12.0) is None


def test_a_grab_selects_and_a_drag_moves_the_whole_edit() -> None:
    selection = EditSelection()
    grab(selection, 1300.0, 2105.0)
    assert selection.selected == "south"
    assert selection.release() is None
    grab(selection, 1300.0, 2105.0)
    selection.drag((1310.0, 2155.0), GRID)
    assert selection.moving is not None
    result = selection.release()

    assert result is not None
    assert result.vertices == ((1110.0, 2150.0), (1510.0, 2150.0))
    assert (selection.moving, selection.selected) == (None, "south")


def test_a_grab_near_a_vertex_moves_that_vertex_alone() -> None:
    selection = EditSelection()
    grab(selection, 1499.0, 2101.0)
    selection.drag((1480.0, 2150.0), GRID)
    result = selection.release()

    assert result is not None
    assert result.vertices == ((1100.0, 2100.0), (1480.0, 2150.0))


def test_the_selected_edit_is_taken_before_a_newer_one_that_covers_the_place() -> None:
    selection = EditSelection()
    selection.selected = "area"
    grab(selection, 1300.0, 2400.0)
    assert selection.selected == "area"
    selection.selected = None
    grab(selection, 1300.0, 2400.0)
    assert selection.selected == "across"


def test_a_grab_of_bare_ground_selects_nothing_and_moves_nothing() -> None:
    selection = EditSelection()
    selection.selected = "south"
    grab(selection, 1000.0, 2000.0)
    selection.drag((1300.0, 2100.0), GRID)

    assert selection.selected is None
    assert selection.release() is None


def test_a_drag_back_to_where_it_began_moves_nothing() -> None:
    selection = EditSelection()
    grab(selection, 1300.0, 2105.0)
    selection.drag((1310.0, 2155.0), GRID)
    selection.drag((1300.0, 2105.0), GRID)
    assert selection.release() is None


def test_a_tool_put_away_leaves_nothing_in_hand() -> None:
    selection = EditSelection()
    selection.is_on = True
    grab(selection, 1300.0, 2105.0)
    selection.drag((1310.0, 2155.0), GRID)
    selection.put_away()

    assert (selection.is_on, selection.selected, selection.moving) == (False, None, None)
    assert selection.release() is None
