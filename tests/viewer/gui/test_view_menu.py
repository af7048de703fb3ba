from collections.abc import Callable

import pytest
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu, QWidget
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import FlyTo, SetOption, TopView
from viewer.gui.view_menu import ViewMenu
from viewer.view_status import ViewStatus

VIEW = FlyTo(1200.0, 2300.0, 400.0, 30.0, 45.0)


@pytest.fixture
def kept() -> list[str]:
    return []


@pytest.fixture
def window(qtbot: QtBot) -> QWidget:
    made = QWidget()
    qtbot.addWidget(made)
    return made


@pytest.fixture
def menu(window: QWidget, record: Recorder, kept: list[str]) -> ViewMenu:
    return ViewMenu(record, lambda: kept.append("now"), window)


def entry(menu: QMenu, text: str) -> QAction:
    return next(action for action in menu.actions() if action.text() == text)


def test_entries_make_their_commands(menu: ViewMenu, record: Recorder, kept: list[str]) -> None:
    entry(menu, "From above").trigger()
    entry(menu, "Wireframe").trigger()
    entry(menu, "Keep this view").trigger()

    assert record.commands == [TopView(), SetOption("wireframe", True)]
    assert kept == ["now"]


def test_what_is_chosen_elsewhere_is_marked_and_asks_for_nothing(menu: ViewMenu, record: Recorder) -> None:
    before = menu.options()
    assert before["exaggeration"] == 1.0
    assert before["show_blocks"] is False
    menu.show_status(
        ViewStatus(
            options=(("exaggeration", 3.0), ("show_blocks", True), ("wireframe", False), ("units", "us"))
        )
    )

    assert menu.options() == {**before, "exaggeration": 3.0, "show_blocks": True, "units": "us"}
    assert record.commands == []


def test_actions_of_panels_stand_first(menu: ViewMenu, window: QWidget) -> None:
    menu.add_first([QAction("Colours", window), QAction("Arrows", window)])

    assert [action.text() for action in menu.actions()[:4]] == ["Colours", "Arrows", "", "Whole terrain"]


def test_a_value_that_the_menu_does_not_offer_is_not_marked(menu: ViewMenu) -> None:
    menu.show_status(ViewStatus(options=(("exaggeration", 2.75), ("gravity", 1.0))))

    assert "exaggeration" not in menu.options()


def test_kept_views_are_flown_to_and_forgotten(menu: ViewMenu, record: Recorder) -> None:
    forgotten: list[str] = []
    forget: Callable[[str], None] = forgotten.append
    assert not menu.kept_views.isEnabled()
    menu.show_views({"Dam": VIEW}, forget)
    entry(menu.kept_views, "Dam").trigger()
    forgetting = entry(menu.kept_views, "Forget").menu()
    assert isinstance(forgetting, QMenu)
    entry(forgetting, "Dam").trigger()

    assert record.commands == [VIEW]
    assert forgotten == ["Dam"]
    assert entry(menu.kept_views, "Dam").shortcut().toString() == "Ctrl+1"
