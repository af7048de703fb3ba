"""Play, pause, seek, speed, follow live, and the time that is shown."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QComboBox, QHBoxLayout, QLabel, QPushButton, QToolButton, QWidget

from viewer.commands import FollowLive, Loop, Seek, SetSpeed, TogglePlay
from viewer.gui.conductor import Dispatch
from viewer.gui.time_slider import TimeSlider
from viewer.view_status import ViewStatus, time_text

__all__ = ["PlaybackBar"]

SPEEDS = (1.0, 5.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0)


class PlaybackBar(QWidget):
    """The bar below the picture.

    Signals:
        stepped: go so many frames forth (or back).
    """

    stepped = Signal(int)

    def __init__(self, dispatch: Dispatch, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.play = QPushButton("Play")
        self.play.setAccessibleName("Play or pause")
        self.play.setToolTip("Play or pause (Space)")
        self.play.setFixedWidth(84)
        self.play.clicked.connect(lambda: dispatch(TogglePlay()))
        self.slider = TimeSlider()
        self.slider.time_chosen.connect(lambda time: dispatch(Seek(time)))
        self.clock = QLabel("00:00:00")
        self.clock.setObjectName("clock")
        self.clock.setToolTip("Simulation time shown / computed so far / end of the run")
        self.extent = QLabel("")
        self.extent.setObjectName("faint")
        self.speed = QComboBox()
        self.speed.setAccessibleName("Playback speed")
        self.speed.setToolTip("Simulated seconds per second of playback")
        for factor in SPEEDS:
            self.speed.addItem(f"{factor:g} x", factor)
        self.speed.activated.connect(lambda row: dispatch(SetSpeed(self.speed.itemData(row))))
        self.back = self._step("|<", "Previous frame (,)", -1)
        self.forth = self._step(">|", "Next frame (.)", 1)
        self.loop = QCheckBox("Loop")
        self.loop.setToolTip("Begin again when playing reaches the end")
        self.loop.clicked.connect(lambda on: dispatch(Loop(on)))
        self.follow = QCheckBox("Follow live")
        self.follow.setToolTip("Stay at the newest computed frame (L)")
        self.follow.clicked.connect(lambda on: dispatch(FollowLive(on)))
        layout = QHBoxLayout(self)
        layout.setContentsMargins(10, 6, 10, 6)
        layout.setSpacing(10)
        layout.addWidget(self.back)
        layout.addWidget(self.play)
        layout.addWidget(self.forth)
        layout.addWidget(self.clock)
        layout.addWidget(self.slider, 1)
        layout.addWidget(self.extent)
        layout.addWidget(self.speed)
        layout.addWidget(self.loop)
        layout.addWidget(self.follow)
        for widget in (self.back, self.play, self.forth, self.speed, self.loop, self.follow):
            widget.setFocusPolicy(Qt.FocusPolicy.TabFocus)

    def _step(self, text: str, tip: str, frames: int) -> QToolButton:
        button = QToolButton()
        button.setText(text)
        button.setAccessibleName(tip.partition(" (")[0])
        button.setToolTip(tip)
        button.clicked.connect(lambda: self.stepped.emit(frames))
        return button

    def show_status(self, status: ViewStatus) -> None:
        """Show where playback stands."""
        self.setEnabled(status.shown_run is not None)
        self.play.setText("Pause" if status.is_playing else "Play")
        self.clock.setText(time_text(status.time))
        self.extent.setText(f"{time_text(status.computed_until)} of {time_text(status.duration)} computed")
        self.slider.show_times(status.time, status.computed_until, status.duration, status.branch_time)
        self.follow.setChecked(status.follows_live)
        self.loop.setChecked(status.loops)
        row = self.speed.findData(status.playback_speed)
        if row < 0:
            self.speed.addItem(f"{status.playback_speed:g} x", status.playback_speed)
            row = self.speed.count() - 1
        self.speed.setCurrentIndex(row)
