from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import OpenWindow, Recorder
from tests.viewer.tiny_service import TOKEN, TinyService
from viewer.commands import ConnectTo, Reconnect
from viewer.gui.connection_panel import ConnectDialog, ConnectionPanel
from viewer.view_status import ViewStatus


def test_the_panel_says_what_the_connection_does(qtbot: QtBot, record: Recorder) -> None:
    panel = ConnectionPanel(record)
    qtbot.addWidget(panel)
    panel.show_status(
        ViewStatus(
            connection="connected to ws://here",
            is_connected=True,
            address="ws://here",
            server="fev-solver 0.1.0",
            session="s-1",
            devices=("cpu", "cuda:0"),
            received_bytes=2_500_000,
            received_bit_s=12.34e6,
        )
    )

    assert panel.state.text() == "connected to ws://here"
    assert panel.devices.text() == "cpu, cuda:0"
    assert panel.traffic.text() == "12.3 Mbit/s, 2.5 MB in all"
    assert not panel.retry.isEnabled()


def test_a_lost_service_can_be_tried_at_once(qtbot: QtBot, record: Recorder) -> None:
    panel = ConnectionPanel(record)
    qtbot.addWidget(panel)
    panel.show_status(ViewStatus(connection="reconnecting in 12 s (attempt 3)"))
    qtbot.mouseClick(panel.retry, Qt.MouseButton.LeftButton)

    assert record.commands == [Reconnect()]


def test_the_dialog_makes_the_command(qtbot: QtBot) -> None:
    dialog = ConnectDialog("ws://here:1")
    qtbot.addWidget(dialog)
    assert dialog.command == ConnectTo("ws://here:1", None)
    dialog.address.setText(" wss://there ")
    dialog.token_file.setText("token.txt")

    assert dialog.command == ConnectTo("wss://there", "token.txt")


def test_another_service_can_be_looked_at_without_leaving_the_window(
    opened: OpenWindow, tmp_path: object
) -> None:
    other = TinyService(computed=5)
    runs = [other.add_run().info.run, other.add_run().info.run]
    token = tmp_path / "token"
    token.write_text(TOKEN, encoding="utf-8")
    opened.app.dispatch(ConnectTo(f"ws://127.0.0.1:{other.port}", str(token)))
    assert opened.status.shown_run is None
    opened.until(lambda: sorted(row.run for row in opened.status.runs) == sorted(runs))

    assert opened.status.shown_run is None
    opened.window.close()
    other.close()
