from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import FollowView, PresentView
from viewer.gui.presenting_menu import PresentingMenu
from viewer.view_status import PresenterRow, ViewStatus

STATUS = ViewStatus(
    is_connected=True,
    has_terrain=True,
    presenters=(PresenterRow("anna-1", "fev-viewer"), PresenterRow("ben-2", "")),
    followed="ben-2",
)


def test_the_presenters_are_offered_and_the_followed_one_is_marked(qtbot: QtBot, record: Recorder) -> None:
    menu = PresentingMenu(record)
    qtbot.addWidget(menu)
    menu.show_status(STATUS)

    assert {action.text(): action.isChecked() for action in menu.actions() if action.text()} == {
        "Present my view": False,
        "Fly freely": False,
        "Follow fev-viewer anna-1": False,
        "Follow session ben-2": True,
    }
    menu.actions()[-2].trigger()
    menu.free.trigger()
    menu.present.trigger()
    assert record.commands == [FollowView("anna-1"), FollowView(None), PresentView(True)]


def test_presenters_who_are_gone_are_not_offered(qtbot: QtBot, record: Recorder) -> None:
    menu = PresentingMenu(record)
    qtbot.addWidget(menu)
    menu.show_status(STATUS)
    menu.show_status(ViewStatus(is_connected=True, has_terrain=True))

    assert len([action for action in menu.actions() if action.text().startswith("Follow")]) == 0
    assert menu.free.isChecked()
    assert not PresentingMenu(record).present.isEnabled()
