"""The service behind the picture: what the connection does, how much comes in, and the way to another one."""

from __future__ import annotations

from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from viewer.commands import ConnectTo, Reconnect
from viewer.gui.conductor import Dispatch
from viewer.view_status import ViewStatus

__all__ = ["ConnectDialog", "ConnectionPanel"]


class ConnectionPanel(QWidget):
    """The connection dock.

    Attributes:
        retry: tries again now instead of at the end of the countdown.
        connect_to: asks for another service.
    """

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self._address = ""
        self.state = self._line("What the connection does")
        self.address = self._line("Address of the service")
        self.server = self._line("Program of the service")
        self.session = self._line("Name of this connection in the logs of the service")
        self.devices = self._line("Devices of the service")
        self.traffic = self._line("What comes in")
        self.retry = QPushButton("Try again now")
        self.retry.setToolTip("Connect now instead of at the end of the countdown")
        self.retry.clicked.connect(lambda: dispatch(Reconnect()))
        self.connect_to = QPushButton("Connect to ...")
        self.connect_to.setToolTip("Leave this service and look at another one")
        self.connect_to.clicked.connect(self.ask)
        form = QFormLayout()
        form.addRow("Service", self.address)
        form.addRow("Program", self.server)
        form.addRow("Session", self.session)
        form.addRow("Devices", self.devices)
        form.addRow("Traffic", self.traffic)
        buttons = QHBoxLayout()
        buttons.addWidget(self.retry)
        buttons.addWidget(self.connect_to)
        layout = QVBoxLayout(self)
        layout.addWidget(self.state)
        layout.addLayout(form)
        layout.addLayout(buttons)
        layout.addStretch(1)

    def show_status(self, status: ViewStatus) -> None:
        """Show the connection."""
        self._address = status.address
        self.state.setText(status.connection)
        self.address.setText(status.address)
        self.server.setText(status.server)
        self.session.setText(status.session)
        self.devices.setText(", ".join(status.devices))
        self.traffic.setText(
            f"{status.received_bit_s / 1e6:.1f} Mbit/s, {status.received_bytes / 1e6:,.1f} MB in all"
        )
        self.retry.setEnabled(not status.is_connected)

    def ask(self) -> None:
        """Ask for another service and connect to it."""
        dialog = ConnectDialog(self._address, self)
        if dialog.exec() == QDialog.DialogCode.Accepted:
            self._dispatch(dialog.command)

    def _line(self, name: str) -> QLabel:
        label = QLabel("")
        label.setAccessibleName(name)
        label.setToolTip(name)
        label.setWordWrap(True)
        return label


class ConnectDialog(QDialog):
    """Asks for the address of a service and the file with the token for it."""

    def __init__(self, address: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Connect to a service")
        self.address = QLineEdit(address)
        self.address.setAccessibleName("Address of the service")
        self.address.setPlaceholderText("ws://HOST:PORT")
        self.token_file = QLineEdit("")
        self.token_file.setAccessibleName("File with the token")
        self.token_file.setPlaceholderText("none")
        browse = QPushButton("Browse ...")
        browse.clicked.connect(self._browse)
        file = QHBoxLayout()
        file.addWidget(self.token_file, 1)
        file.addWidget(browse)
        self.buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel
        )
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        form = QFormLayout(self)
        form.addRow("Address", self.address)
        form.addRow("Token file", file)
        form.addRow(self.buttons)
        self.setMinimumWidth(460)

    @property
    def command(self) -> ConnectTo:
        """What was asked for."""
        return ConnectTo(self.address.text().strip(), self.token_file.text().strip() or None)

    def _browse(self) -> None:
        chosen, _ = QFileDialog.getOpenFileName(self, "File with the token")
        if chosen:
            self.token_file.setText(chosen)
