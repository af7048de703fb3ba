import pytest
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from tests.viewer.tiny_service import TOKEN, TinyService
from viewer.app.viewer_app import ViewerApp
from viewer.app.window import make_window, prepare_window, run_window
from viewer.errors import ContextError
from viewer.net import ConnectionThread, FrameLoader


def test_without_a_display_a_sentence_names_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("viewer.app.window.has_display", lambda: False)

    with pytest.raises(ContextError, match="--headless DIR"):
        prepare_window()


def test_the_window_runs_until_it_is_closed_and_closes_what_is_behind_it(qapp: QApplication) -> None:

    service = TinyService()
    connection = ConnectionThread(service.url, TOKEN)
    app = ViewerApp(connection, FrameLoader())
    connection.start()
    closed: list[bool] = []

    def close_all() -> None:
        for window in QApplication.topLevelWidgets():
            window.close()
        qapp.quit()

    QTimer.singleShot(1500, close_all)
    status = run_window(app, lambda: (closed.append(True), app.close()))  # type: ignore[func-returns-value]
    service.close()

    assert status == 0
    assert closed == [True]


def test_the_window_is_made_without_being_shown(qapp: QApplication) -> None:
    connection = ConnectionThread("ws://127.0.0.1:9/v1/stream", None)
    app = ViewerApp(connection, FrameLoader())
    window = make_window(app)

    assert not window.isVisible()
    assert window.windowTitle() == "Flood Emergency Visualizer"
    window.close()
    window.deleteLater()
    app.close()
