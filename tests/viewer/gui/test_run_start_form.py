import dataclasses

import pytest
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import StartRun
from viewer.gui.run_start_form import RunStartForm
from viewer.view_status import CaseRow, ForcingRow, RunRow, ViewStatus

CASES = (
    CaseRow("jacksboro", "A dam break", 3600.0, 20.0, 547_479, True),
    CaseRow("malpasset", "The 1959 disaster", 4000.0, 20.0, 705_000, False),
)
RUN = RunRow("r1", None, "jacksboro", "A dam break", "paused", None, 600.0, 3600.0, "cpu")
STATUS = ViewStatus(is_connected=True, cases=CASES, runs=(RUN,), shown_run="r1", devices=("cpu", "cuda:0"))
CHANGED = ForcingRow("spring", "source", "m3/s", "5 m3/s", factor=2.0, is_changed=True)


@pytest.fixture
def form(qtbot: QtBot, record: Recorder) -> RunStartForm:
    made = RunStartForm(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def test_a_case_brings_its_own_duration_and_interval(form: RunStartForm) -> None:
    form.choose_case("malpasset")

    assert form.duration_min.value() == pytest.approx(4000.0 / 60.0, abs=0.1)
    assert form.interval_s.value() == 20.0
    assert "705,000 cells" in form.about.text()


def test_start_sends_what_is_chosen(form: RunStartForm, record: Recorder) -> None:
    form.choose_case("jacksboro")
    form.duration_min.setValue(30.0)
    form.interval_s.setValue(10.0)
    form.device.setCurrentText("cuda:0")
    form.start.click()

    assert record.commands == [StartRun("jacksboro", 1800.0, 10.0, "cuda:0")]


def test_the_devices_are_those_of_the_service(form: RunStartForm) -> None:
    assert [form.device.itemText(k) for k in range(form.device.count())] == ["auto", "cpu", "cuda:0"]


def test_a_run_starts_with_the_changed_forcing_of_its_own_case_alone(
    form: RunStartForm, record: Recorder
) -> None:
    assert not form.with_forcing.isEnabled()
    form.show_status(dataclasses.replace(STATUS, forcing=(CHANGED,)))
    assert form.with_forcing.isEnabled()
    form.with_forcing.click()
    form.start.click()
    form.choose_case("malpasset")
    assert not form.with_forcing.isEnabled()
    form.start.click()

    assert [command.with_forcing for command in record.commands if isinstance(command, StartRun)] == [
        True,
        False,
    ]


def test_nothing_starts_without_a_service(form: RunStartForm) -> None:
    form.show_status(dataclasses.replace(STATUS, is_connected=False))

    assert not form.start.isEnabled()
