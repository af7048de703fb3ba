import pytest

from protocol import Progress, WaterBudget
from solver_service.runs import RunStatus
from tests.end_to_end.dam_break import CELLS
from tests.solver_service.runs.conftest import Service


def test_progress_and_the_water_budget_are_told_while_a_run_computes(service: Service) -> None:
    run = service.call(service.registry.control.start("dam-break", 300.0))
    service.wait_for_status(run, RunStatus.FINISHED)
    service.wait(lambda: any(isinstance(m, WaterBudget) and m.time == 300.0 for m in service.heard))
    progress = [m for m in service.heard if isinstance(m, Progress) and m.run == run.run]
    last = progress[-1]
    assert last.limiting_cell is not None
    assert all(0 <= index < CELLS for index in last.limiting_cell)
    assert 0.0 < last.dt < 5.0
    assert (last.time, last.eta_s) == (300.0, 0.0)
    early = next(m for m in progress if m.eta_s)
    assert early.eta_s == pytest.approx((300.0 - early.time) / early.speed_x_real_time)
    budgets = [m for m in service.heard if isinstance(m, WaterBudget) and m.run == run.run]
    final = budgets[-1]
    assert final.time == 300.0
    assert final.initial > 1000.0
    assert final.outflow == pytest.approx(sum(final.edges_out.values()))
    assert final.outflow > 0.0
    explained = final.initial + final.inflow + final.rain - final.infiltration - final.outflow - final.edits
    assert final.stored - explained == pytest.approx(final.error, abs=1e-6 * final.initial)
    assert abs(final.error_relative) < 1e-6
    assert last.volume_error_relative == final.error_relative


def test_news_that_were_due_when_a_run_was_deleted_are_dropped(
    service: Service, caplog: pytest.LogCaptureFixture
) -> None:
    registry = service.registry
    run = service.call(registry.control.start("dam-break", 1e4))
    service.wait(lambda: run.frame_count > 1)
    service.call(registry.control.stop(run.run))
    assert run.run in registry.reports._announced_soon, "news are due"
    service.call(registry.control.delete(run.run))
    service.wait(lambda: run.run not in registry.reports._announced_soon)
    assert "Exception in callback" not in caplog.text
