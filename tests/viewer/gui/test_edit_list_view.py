import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from pytestqt.qtbot import QtBot

from viewer.gui.edit_list_view import EditListView
from viewer.view_status import EditRow, EditSettings

ROWS = (
    EditRow("a", "Raise by 8 m", True, "120 m long", "overtopped at 00:10:00", "North", centre=(5.0, 6.0)),
    EditRow("b", "Lower by 2 m", False, settings=EditSettings(operation="lower")),
)
UNDONE = (EditRow("c", "Raise by 1 m", False, name="Gone"),)


@pytest.fixture
def chosen() -> list[object]:
    return []


@pytest.fixture
def view(qtbot: QtBot, chosen: list[object]) -> EditListView:
    made = EditListView(chosen.append, chosen.append)
    qtbot.addWidget(made)
    made.resize(300, 300)
    made.show()
    made.show_rows(ROWS, UNDONE, None)
    return made


def texts(view: EditListView) -> list[str]:
    return [view.item(row).text() for row in range(view.count())]


def test_it_shows_names_measures_warnings_and_what_is_not_computed_yet(view: EditListView) -> None:
    assert texts(view) == [
        "North: Raise by 8 m\n120 m long\novertopped at 00:10:00",
        "new: Lower by 2 m",
        "undone: Gone: Raise by 1 m",
    ]


def test_raise_and_lower_have_their_colours_and_a_warning_stands_out(view: EditListView) -> None:
    colours = [view.item(row).icon().pixmap(10, 10).toImage().pixelColor(5, 5).name() for row in range(2)]
    assert colours == ["#ffb84d", "#8cbfff"]
    assert view.item(0).foreground().color() != view.item(1).foreground().color()


def test_an_undone_edit_is_greyed_and_cannot_be_selected(view: EditListView) -> None:
    item = view.item(2)
    assert item.flags() == Qt.ItemFlag.NoItemFlags
    assert item.font().italic()


def test_a_click_selects_and_a_double_click_flies_there(
    view: EditListView, chosen: list[object], qtbot: QtBot
) -> None:
    where = view.visualItemRect(view.item(0)).center()
    qtbot.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=where)
    assert chosen == ["a"]
    qtbot.mouseDClick(view.viewport(), Qt.MouseButton.LeftButton, pos=where)
    assert chosen[-1] == (5.0, 6.0)


def test_the_selection_follows_what_is_selected_elsewhere_without_asking(
    view: EditListView, chosen: list[object]
) -> None:
    view.show_rows(ROWS, UNDONE, "b")
    assert [item.text() for item in view.selectedItems()] == ["new: Lower by 2 m"]
    view.show_rows(ROWS, UNDONE, None)
    assert view.selectedItems() == []
    assert chosen == []


def test_rows_that_are_the_same_are_not_made_anew(view: EditListView) -> None:
    item = view.item(0)
    view.show_rows(ROWS, UNDONE, "a")
    assert view.item(0) is item
    view.show_rows(ROWS[1:], (), None)
    assert texts(view) == ["new: Lower by 2 m"]


def test_the_right_button_opens_the_menu_on_an_edit_alone(view: EditListView, qtbot: QtBot) -> None:
    view.add_to_menu([QAction("Rename", view)])
    view.customContextMenuRequested.emit(view.visualItemRect(view.item(2)).center())
    assert not view.menu.isVisible()
    view.customContextMenuRequested.emit(view.visualItemRect(view.item(1)).center())
    qtbot.waitUntil(view.menu.isVisible)
    assert [action.text() for action in view.menu.actions()] == ["Rename"]
    view.menu.close()
