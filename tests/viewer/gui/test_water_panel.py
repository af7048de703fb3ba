import dataclasses

import pytest
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import SetOption
from viewer.gui.water_panel import COLOURS, WaterPanel
from viewer.view_status import LegendRow, ViewStatus
from viewer.world import WaterColour

EVERYTHING = tuple(colour.value for colour in WaterColour)


@pytest.fixture
def panel(qtbot: QtBot, record: Recorder) -> WaterPanel:
    made = WaterPanel(record)
    qtbot.addWidget(made)
    return made


def test_every_way_to_colour_is_offered() -> None:
    assert tuple(value for value, _ in COLOURS) == EVERYTHING


def test_what_the_run_does_not_keep_is_greyed_and_said(panel: WaterPanel) -> None:
    panel.show_status(ViewStatus(water_colour="speed", water_note="The run keeps no velocity."))
    rows = [panel.colour.model().item(row) for row in range(panel.colour.count())]  # type: ignore[attr-defined]

    assert [row.isEnabled() for row in rows] == [True, True, *[False] * 6]
    assert "does not keep" in rows[2].toolTip()
    assert not panel.arrows.isEnabled()
    assert panel.colour.currentText() == "Speed"
    assert panel.note.text() == "The run keeps no velocity."

    panel.show_status(ViewStatus(water_colours=EVERYTHING))
    assert all(row.isEnabled() for row in rows)
    assert panel.arrows.isEnabled()


def test_a_choice_makes_its_command(panel: WaterPanel, record: Recorder) -> None:
    panel.show_status(ViewStatus(water_colours=EVERYTHING))
    panel.colour.activated.emit(3)
    panel.toggle_arrows.trigger()

    assert record.commands == [SetOption("water_colour", "hazard"), SetOption("flow_arrows", True)]


def test_the_key_goes_round_what_is_offered(panel: WaterPanel, record: Recorder) -> None:
    status = ViewStatus(water_colours=("natural", "depth", "arrival"))
    for now in ("natural", "depth", "arrival", "speed"):
        panel.show_status(dataclasses.replace(status, water_colour=now))
        panel.next_colour.trigger()

    values = [command.value for command in record.commands if isinstance(command, SetOption)]
    assert values == ["depth", "arrival", "natural", "natural"]


def test_the_legend_names_every_class_with_the_highest_on_top(panel: WaterPanel, qtbot: QtBot) -> None:
    rows = (LegendRow((255, 0, 0), "< 1"), LegendRow((0, 0, 255), "> 1"))
    panel.show_status(ViewStatus(legend=rows))
    top, text = panel.legend.itemAtPosition(0, 0), panel.legend.itemAtPosition(0, 1)

    assert top is not None
    assert text is not None
    swatch, label = top.widget(), text.widget()
    assert isinstance(swatch, QLabel)
    assert isinstance(label, QLabel)
    assert label.text() == "> 1"
    assert swatch.pixmap().toImage().pixelColor(5, 5).getRgb()[:3] == (0, 0, 255)
    panel.show_status(ViewStatus())
    assert panel.legend.count() == 0
