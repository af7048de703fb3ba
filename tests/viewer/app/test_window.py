import os
import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication

from tests.viewer.gl_thread import let_go_of_egl
from viewer.app.viewer_app import ViewerApp
from viewer.app.window import make_window, prepare_window
from viewer.errors import ContextError
from viewer.net import ConnectionThread, FrameLoader

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(autouse=True)
def _no_foreign_context_is_current() -> None:
    let_go_of_egl()


def test_without_a_display_a_sentence_names_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("viewer.app.window.has_display", lambda: False)

    with pytest.raises(ContextError, match="--headless DIR"):
        prepare_window()


PROGRAM = """
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
from tests.viewer.tiny_service import TOKEN, TinyService
from viewer.app.viewer_app import ViewerApp
from viewer.app.window import prepare_window, run_window
from viewer.net import ConnectionThread, FrameLoader

service = TinyService()
connection = ConnectionThread(service.url, TOKEN)
app = ViewerApp(connection, FrameLoader())
connection.start()
prepare_window()
QTimer.singleShot(1500, lambda: [window.close() for window in QApplication.topLevelWidgets()])
status = run_window(app, app.close)
print(status, connection.state.phase)
service.close()
"""


def test_the_window_runs_until_it_is_closed_closes_what_is_behind_it_and_keeps_its_settings(
    display: str, tmp_path: Path
) -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "XDG_CONFIG_HOME": str(tmp_path)},
    )

    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["0", "closed"]
    assert "exaggeration" in (tmp_path / "fev" / "fev-viewer.conf").read_text(encoding="utf-8")


def test_the_window_is_made_without_being_shown(qapp: QApplication) -> None:
    connection = ConnectionThread("ws://127.0.0.1:9/v1/stream", None)
    app = ViewerApp(connection, FrameLoader())
    window = make_window(app)

    assert not window.isVisible()
    assert window.windowTitle() == "Flood Emergency Visualizer"
    window.close()
    window.deleteLater()
    app.close()
