import dataclasses

import pytest
from pytestqt.qtbot import QtBot

from tests.viewer.gui.conftest import Recorder
from viewer.commands import Recalculate, ResetForcing
from viewer.gui.forcing_panel import ForcingPanel
from viewer.view_status import ForcingRow, ViewStatus

SPRING = ForcingRow("spring", "source", "m3/s", "5 m3/s")
DAM = ForcingRow("dam", "breach", "s", "at 00:05:00", case_start=300.0)
STATUS = ViewStatus(is_connected=True, forcing=(SPRING, DAM), time=65.0, can_recalculate=True)


@pytest.fixture
def panel(qtbot: QtBot, record: Recorder) -> ForcingPanel:
    made = ForcingPanel(record)
    qtbot.addWidget(made)
    made.show()
    made.show_status(STATUS)
    return made


def test_every_item_has_its_row_and_keeps_it(panel: ForcingPanel) -> None:
    rows = list(panel.rows)
    assert [row.item for row in rows] == ["spring", "dam"]
    panel.show_status(dataclasses.replace(STATUS, forcing=(dataclasses.replace(SPRING, factor=2.0), DAM)))
    assert panel.rows == rows
    assert rows[0].factor.value() == 2.0
    panel.show_status(dataclasses.replace(STATUS, forcing=(DAM,)))
    assert [row.item for row in panel.rows] == ["dam"]


def test_what_is_not_recalculated_yet_is_counted_and_computed_by_one_button(
    panel: ForcingPanel, record: Recorder
) -> None:
    assert "is computed with this forcing" in panel.summary.text()
    assert not panel.reset.isEnabled()
    changed = dataclasses.replace(SPRING, factor=2.0, is_changed=True, is_pending=True)
    panel.show_status(dataclasses.replace(STATUS, forcing=(changed, DAM)))
    assert panel.summary.text() == "1 changed and not recalculated yet."
    assert panel.recalculate.text() == "Recalculate from 00:01:05"
    panel.recalculate.click()
    panel.reset.click()

    assert record.commands == [Recalculate(), ResetForcing()]


def test_nothing_can_be_changed_without_a_service_or_a_run(panel: ForcingPanel) -> None:
    panel.show_status(dataclasses.replace(STATUS, is_connected=False, can_recalculate=False))
    assert not any(row.isEnabled() for row in panel.rows)
    assert not panel.recalculate.isEnabled()
    panel.show_status(ViewStatus())
    assert panel.rows == []
    assert panel.summary.text() == "No run is shown."
