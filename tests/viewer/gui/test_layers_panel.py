import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import OpenWindow, Recorder
from viewer.commands import SetOption
from viewer.gui.layers_panel import LayersPanel
from viewer.view_status import ViewStatus

STATUS = ViewStatus(
    options=(("show_water", True), ("show_sky", False), ("exaggeration", 2.0), ("light_azimuth_deg", 90.0))
)


@pytest.fixture
def panel(qtbot: QtBot, record: Recorder) -> LayersPanel:
    made = LayersPanel(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def test_it_shows_what_is_chosen_and_asks_for_nothing(panel: LayersPanel, record: Recorder) -> None:
    assert panel.layers["show_water"].isChecked()
    assert not panel.layers["show_sky"].isChecked()
    assert panel.sliders["exaggeration"].number.text() == "2 x"
    assert panel.sliders["light_azimuth_deg"].value == 90.0
    assert record.commands == []


def test_a_click_on_a_layer_and_a_key_on_a_slider_make_commands(
    panel: LayersPanel, record: Recorder, qtbot: QtBot
) -> None:
    box, slider = panel.layers["show_sky"], panel.sliders["exaggeration"].slider
    qtbot.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(6, box.height() // 2))
    qtbot.keyClick(slider, Qt.Key.Key_Right)

    assert record.commands == [SetOption("show_sky", True), SetOption("exaggeration", 2.25)]
    assert panel.sliders["exaggeration"].number.text() == "2.25 x"


def test_panel_and_menu_show_the_same(opened: OpenWindow) -> None:
    opened.app.dispatch(SetOption("exaggeration", 3.0))
    opened.app.dispatch(SetOption("show_imagery", False))
    opened.until(lambda: opened.window.view_menu.options()["exaggeration"] == 3.0)

    assert not opened.window.layers_panel.layers["show_imagery"].isChecked()
    assert opened.window.layers_panel.sliders["exaggeration"].value == 3.0


def test_every_layer_is_an_option_of_the_picture(opened: OpenWindow) -> None:
    panel = opened.window.layers_panel
    known = {name for name, _ in opened.status.options}

    assert set(panel.layers) | set(panel.sliders) <= known


def test_a_picture_without_text_or_marks_has_none(opened: OpenWindow) -> None:
    opened.app.dispatch(SetOption("show_text", False))
    opened.app.dispatch(SetOption("show_edits", False))
    inputs = opened.app.frame_inputs()

    assert inputs is not None
    assert inputs.edits is None
    assert inputs.hud is not None
    assert inputs.hud.title == inputs.hud.detail == ""
    assert inputs.hud.is_hypothetical  # told on every picture
