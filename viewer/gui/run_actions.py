"""What can be done to the shown run: hold, end, branch, name, keep, delete it, and who controls it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import (
    QGridLayout,
    QInputDialog,
    QLabel,
    QMessageBox,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from viewer.commands import (
    Command,
    DeleteRun,
    PauseRun,
    PinRun,
    Recalculate,
    ReleaseControl,
    RenameRun,
    ResumeRun,
    StopRun,
    TakeControl,
    UnpinRun,
)
from viewer.gui.conductor import Dispatch
from viewer.view_status import RunRow, ViewStatus, time_text

__all__ = ["RunActions"]

Make = Callable[[], Command | None]


class RunActions(QWidget):
    """Buttons for the shown run; what its status does not allow is greyed out."""

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._dispatch = dispatch
        self._row: RunRow | None = None
        self._session = ""
        self.pause = self._button("Pause", "Hold the computation of the shown run", lambda: PauseRun())
        self.resume = self._button("Resume", "Let the shown run go on", lambda: ResumeRun())
        self.stop = self._button(
            "Stop", "End the computation of the shown run for good; its frames stay", lambda: StopRun()
        )
        self.branch = self._button(
            "Branch here",
            "Compute anew from the time shown, with the edits and the forcing as they are now",
            lambda: Recalculate(),
        )
        self.rename = self._button("Rename ...", "Give the shown run a name", self._renamed)
        self.pin = self._button("Pin", "Keep the shown run whatever room the store needs", self._pinned)
        self.delete = self._button("Delete ...", "Forget the shown run and its frames", self._deleted)
        self.control = QLabel("")
        self.control.setWordWrap(True)
        self.control.setAccessibleName("Who controls the shown run")
        self.take = self._button(
            "Take control", "Control the shown run: whoever controls it changes it", self._taken
        )
        self.hand_over = self._button(
            "Hand over", "Give the control to whoever asked for it", lambda: ReleaseControl(to=self._asker())
        )
        self.release = self._button("Release", "Control the shown run no longer", lambda: ReleaseControl())
        self._lay_out()

    def show_status(self, status: ViewStatus) -> None:
        """Grey out what is not allowed now, and say who controls the run."""
        row = next((row for row in status.runs if row.run == status.shown_run), None)
        self._row, self._session = row, status.session
        moves = row.moves if row is not None and status.is_connected else ()
        for button, names in (
            (self.pause, ("pause",)),
            (self.resume, ("resume",)),
            (self.stop, ("stop",)),
            (self.delete, ("delete",)),
            (self.pin, ("pin", "unpin")),
        ):
            button.setEnabled(any(name in moves for name in names))
        is_pinned = row is not None and row.pinned
        self.pin.setText("Unpin" if is_pinned else "Pin")
        self.branch.setText(f"Branch at {time_text(status.time)}")
        self.branch.setEnabled(status.can_recalculate)
        self.rename.setEnabled(row is not None and status.is_connected)
        self._show_control(row, status.is_connected)

    def _show_control(self, row: RunRow | None, is_connected: bool) -> None:
        holder, client = ("", "") if row is None else row.controller
        is_mine = bool(holder) and holder == self._session
        asker = "" if row is None else row.asker
        if row is None:
            text = ""
        elif is_mine:
            text = "You control this run." + (f" Session {asker} asks for it." if asker else "")
        elif holder:
            text = f"{client or 'Another session'} ({holder}) controls this run; you follow."
        else:
            text = "Nobody controls this run; the first command takes it."
        self.control.setText(text)
        self.take.setText("Take by force" if holder and not is_mine else "Take control")
        self.take.setEnabled(is_connected and row is not None and not is_mine)
        self.hand_over.setEnabled(is_connected and is_mine and bool(asker))
        self.release.setEnabled(is_connected and is_mine)

    def _asker(self) -> str | None:
        return self._row.asker or None if self._row is not None else None

    def _taken(self) -> Command | None:
        holder = "" if self._row is None else self._row.controller[0]
        if not holder:
            return TakeControl()
        question = f"Session {holder} controls this run. Ask for it, or take it by force?"
        box = QMessageBox(QMessageBox.Icon.Question, "Take control", question, parent=self)
        ask = box.addButton("Ask", QMessageBox.ButtonRole.AcceptRole)
        force = box.addButton("Take by force", QMessageBox.ButtonRole.DestructiveRole)
        box.addButton(QMessageBox.StandardButton.Cancel)
        box.exec()
        if box.clickedButton() is ask:
            return TakeControl()
        return TakeControl(force=True) if box.clickedButton() is force else None

    def _renamed(self) -> Command | None:
        before = "" if self._row is None else self._row.label
        name, is_given = QInputDialog.getText(self, "Rename the run", "Name", text=before)
        return RenameRun(name.strip()) if is_given else None

    def _pinned(self) -> Command:
        return UnpinRun() if self._row is not None and self._row.pinned else PinRun()

    def _deleted(self) -> Command | None:
        asked = QMessageBox.question(self, "Delete the run", "Forget this run and all its frames?")
        return DeleteRun() if asked is QMessageBox.StandardButton.Yes else None

    def _button(self, text: str, tip: str, make: Make) -> QPushButton:
        button = QPushButton(text)
        button.setToolTip(tip)
        button.setAccessibleName(text.removesuffix(" ..."))

        def clicked() -> None:
            command = make()
            if command is not None:
                self._dispatch(command)

        button.clicked.connect(clicked)
        return button

    def _lay_out(self) -> None:
        grid = QGridLayout()
        grid.setSpacing(4)
        for place, button in enumerate((self.pause, self.resume, self.stop)):
            grid.addWidget(button, 0, place)
        grid.addWidget(self.branch, 1, 0, 1, 3)
        for place, button in enumerate((self.rename, self.pin, self.delete)):
            grid.addWidget(button, 2, place)
        for place, button in enumerate((self.take, self.hand_over, self.release)):
            grid.addWidget(button, 4, place)
        grid.addWidget(self.control, 3, 0, 1, 3)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addLayout(grid)
