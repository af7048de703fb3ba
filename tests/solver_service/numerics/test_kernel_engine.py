"""How the kernel engine goes to its target: in one launch, or asking now and then whether to stop."""

import numpy as np
import pytest

from solver_service.numerics import kernel_engine
from tests.solver_service.numerics.floods import GAUGES, differences, full_model, solver, wild_water


def begun(engine="tiles", **params):
    model = full_model()
    s = solver(model, engine=engine, gauges=GAUGES, **params)
    s.set_water(*wild_water(model.z_b))
    return s


def count_launches(s, monkeypatch):
    launches = []
    launch = s._engine._launch_steps
    monkeypatch.setattr(s._engine, "_launch_steps", lambda limit: (launches.append(limit), launch(limit)))
    return launches


@pytest.mark.parametrize("engine", ["tiles", "kernels"])
def test_an_interval_is_one_launch_when_nobody_asks_to_stop(engine, monkeypatch):
    s = begun(engine)
    launches = count_launches(s, monkeypatch)
    s.advance_to(11.0)
    assert s.step_count > 20
    assert len(launches) == 1


def test_how_often_it_is_asked_to_stop_changes_no_bit(monkeypatch):
    whole = begun()
    whole.advance_to(11.0)
    asked = begun()
    launches = count_launches(asked, monkeypatch)
    monkeypatch.setattr(asked._engine, "_learn", lambda steps, seconds: None)
    asked._engine._steps_between_questions = 4
    asked.advance_to(11.0, should_stop=lambda: False)
    assert len(launches) > 5
    assert differences(whole, asked) == []


def test_a_stop_leaves_a_state_that_goes_on_to_the_same_target():
    s = begun()
    s._engine._steps_between_questions = 4
    questions = iter([False, True])
    assert not s.advance_to(11.0, should_stop=lambda: next(questions))
    assert 0.0 < s.time < 11.0
    assert s.advance_to(11.0)
    assert s.time == 11.0


def test_questions_follow_the_measured_time_of_a_step():
    engine = begun()._engine
    for _ in range(20):
        engine._learn(100, 100 * 1e-3)
    assert engine._steps_between_questions == pytest.approx(kernel_engine.QUESTION_SECONDS / 1e-3)
    for _ in range(20):
        engine._learn(4, 4 * 10.0)
    assert engine._steps_between_questions == kernel_engine.REFRESH_STEPS


def test_gauges_whose_memory_a_launch_could_fill_bound_it(monkeypatch):
    s = begun(gauge_interval=0.5)
    launches = count_launches(s, monkeypatch)
    room = s._gauges._records.shape[0]
    s.advance_to(3.0)
    assert launches.pop() > 256
    assert s._gauges.steps_with_room(0.5 * (room - 1)) == 256
    s.advance_to(0.5 * room + 10.0)
    assert launches[0] == 256
    assert len(s.gauge_series().times) == room + 21
    assert np.isfinite(s.gauge_series().h).all()
