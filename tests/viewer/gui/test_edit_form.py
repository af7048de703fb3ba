from typing import Any

import pytest
from pytestqt.qtbot import QtBot

from viewer.gui.edit_form import EditForm
from viewer.units import METRIC, US
from viewer.view_status import EditSettings

TRENCH = EditSettings(25.0, 4.0, "lower", "replace", 312.5, True)


class Asked:
    """Takes what the form asks for."""

    def __init__(self) -> None:
        self.changes: list[dict[str, Any]] = []
        self.picks = 0

    def change(self, **settings: Any) -> None:
        self.changes.append(settings)

    def pick(self) -> None:
        self.picks += 1


@pytest.fixture
def asked() -> Asked:
    return Asked()


@pytest.fixture
def form(qtbot: QtBot, asked: Asked) -> EditForm:
    made = EditForm(asked.change, asked.pick)
    qtbot.addWidget(made)
    made.show()
    made.show_settings(TRENCH, METRIC)
    return made


def test_it_shows_an_edit_without_asking_for_a_change(form: EditForm, asked: Asked) -> None:
    assert (form.width_m.value(), form.magnitude_m.value(), form.level_m.value()) == (25.0, 4.0, 312.5)
    assert form.operation.buttons["lower"].isChecked()
    assert form.crest.buttons["level"].isChecked()
    assert asked.changes == []


def test_what_means_nothing_to_the_edit_is_greyed(form: EditForm) -> None:
    assert (form.magnitude_m.isEnabled(), form.level_m.isEnabled(), form.width_m.isEnabled()) == (
        False,
        True,
        True,
    )
    form.show_settings(EditSettings(), METRIC, is_area=True)
    assert (form.magnitude_m.isEnabled(), form.level_m.isEnabled(), form.width_m.isEnabled()) == (
        True,
        False,
        False,
    )


def test_each_field_asks_for_its_change(form: EditForm, asked: Asked) -> None:
    form.width_m.setValue(30.0)
    form.level_m.setValue(313.25)
    form.operation.buttons["raise"].click()
    form.crest.buttons["even"].click()
    form.crest.buttons["modulate"].click()
    form.crest.buttons["level"].click()
    form.pick.click()

    assert asked.changes == [
        {"width": 30.0},
        {"level": 313.25},
        {"operation": "raise"},
        {"type": "replace", "at_level": False},
        {"type": "modulate", "at_level": False},
        {"type": "replace", "at_level": True},
    ]
    assert asked.picks == 1


def test_fields_speak_the_units_wanted_and_ask_in_metres(form: EditForm, asked: Asked) -> None:
    form.show_settings(TRENCH, US)
    assert form.width_m.suffix() == " ft"
    assert form.width_m.value() == pytest.approx(82.0)
    assert asked.changes == []
    form.width_m.setValue(100.0)
    assert asked.changes == [{"width": pytest.approx(30.48)}]


def test_every_field_has_a_name_and_a_tip(form: EditForm) -> None:
    boxes = (form.width_m, form.magnitude_m, form.level_m)
    assert [box.accessibleName() for box in boxes] == ["Width", "Magnitude", "Level"]
    assert all(widget.toolTip() for widget in (*boxes, form.pick))
