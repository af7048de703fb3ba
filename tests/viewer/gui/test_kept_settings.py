from pathlib import Path

import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtWidgets import QDockWidget, QMainWindow
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import OpenWindow
from viewer.commands import ChangeEditSettings, FlyTo, SetOption
from viewer.gui.kept_settings import VIEWS_KEPT, KeptSettings
from viewer.render import RenderOptions
from viewer.view_status import EditSettings

VIEW = FlyTo(1200.0, 2300.0, 400.0, 30.0, 45.0)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "viewer.ini"


def settings(path: Path) -> KeptSettings:
    return KeptSettings(QSettings(str(path), QSettings.Format.IniFormat))


def test_nothing_kept_is_no_settings(path: Path) -> None:
    empty = settings(path)

    assert empty.options() == {}
    assert empty.edit_settings() == ChangeEditSettings()
    assert empty.views("Valley") == {}
    assert empty.map_shown()


def test_what_is_kept_comes_back_from_the_file(path: Path) -> None:
    kept = settings(path)
    kept.keep_options({"exaggeration": 3.0, "wireframe": True})
    kept.keep_map_shown(False)
    kept.keep_edit_settings(EditSettings(25.0, 3.0, "lower", "replace"))
    kept.keep_views("Dam / break", {"Dam": VIEW})
    del kept
    again = settings(path)

    assert again.options() == {"exaggeration": 3.0, "wireframe": True}
    assert not again.map_shown()
    assert again.edit_settings() == ChangeEditSettings(25.0, 3.0, "lower", "replace", 0.0, False)
    assert again.views("Dam / break") == {"Dam": VIEW}
    assert again.views("Other") == {}


def test_what_is_not_valid_is_left_out(path: Path) -> None:
    store = QSettings(str(path), QSettings.Format.IniFormat)
    store.setValue("picture/options", '{"exaggeration": [2], "tau_px": NaN, "wireframe": true}')
    store.setValue("edits/tool", '{"width": "wide"}')
    store.setValue("views/Valley", '{"one": {"x": 1.0}, "two": 5, "three": {"x": 1.0, "y": 2.0}}')
    store.setValue("picture/map", "[1, 2")
    kept = KeptSettings(store)

    assert kept.options() == {"wireframe": True}
    assert kept.edit_settings() == ChangeEditSettings()
    assert list(kept.views("Valley")) == ["three"]
    assert kept.map_shown()


def test_only_the_newest_views_are_kept(path: Path) -> None:
    kept = settings(path)
    kept.keep_views("Valley", {f"View {k}": VIEW for k in range(VIEWS_KEPT + 5)})

    assert next(iter(kept.views("Valley"))) == "View 5"
    assert len(kept.views("Valley")) == VIEWS_KEPT


def test_docks_come_back_where_they_were(path: Path, qtbot: QtBot) -> None:
    def window() -> tuple[QMainWindow, QDockWidget]:
        made = QMainWindow()
        qtbot.addWidget(made)
        dock = QDockWidget("Runs", made)
        dock.setObjectName("Runs")
        made.addDockWidget(Qt.DockWidgetArea.RightDockWidgetArea, dock)
        return made, dock

    first, dock = window()
    first.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, dock)
    settings(path).keep_window(first)
    second, dock = window()
    settings(path).restore_window(second)

    assert second.dockWidgetArea(dock) == Qt.DockWidgetArea.LeftDockWidgetArea


def test_a_window_opened_again_looks_as_it_was_left(
    opened: OpenWindow, path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    window = opened.window
    window._kept = settings(path)
    opened.app.dispatch(SetOption("exaggeration", 2.0))
    opened.app.dispatch(ChangeEditSettings(width=75.0))
    opened.until(lambda: opened.app.status().edit_settings.width == 75.0)
    opened.until(lambda: dict(opened.app.status().options)["exaggeration"] == 2.0)
    monkeypatch.setattr(
        "viewer.gui.main_window.QInputDialog.getText", lambda *args, **kwargs: (kwargs["text"], True)
    )
    window._keep_view()
    title = opened.status.title
    window.close()
    again = settings(path)

    assert again.options()["exaggeration"] == 2.0
    assert again.edit_settings() == ChangeEditSettings(75.0, 8.0, "raise", "modulate", 0.0, False)
    (view,) = again.views(title).values()
    assert opened.app.camera_work is not None
    assert view == opened.app.camera_work.pose()


def test_a_window_takes_up_what_was_kept(opened: OpenWindow, path: Path) -> None:
    kept = settings(path)
    kept.keep_options({"exaggeration": 5.0, "tau_px": "large", "gravity": 9.81})
    kept.keep_map_shown(False)
    kept.keep_edit_settings(EditSettings(75.0, 3.0, "lower", "modulate"))
    opened.window._kept = kept
    opened.window._restore()

    assert opened.app.options.exaggeration == 5.0
    assert opened.app.options.tau_px == RenderOptions().tau_px
    assert opened.app.message == ""
    assert not opened.window.reference_map.isVisible()
    opened.until(lambda: opened.status.edit_settings.operation == "lower")
