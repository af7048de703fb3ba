"""A small dose of `python -m bench slow_viewers`, whose kept figures are in bench/results."""

import pytest

from bench.slow_viewers import figures


@pytest.mark.slow
def test_slow_dead_and_many_viewers_get_what_they_can_take_and_cost_the_service_little() -> None:
    lines = {str(line["figure"]): float(str(line["value"])) for line in figures(smoke=True)}
    assert lines["dead_rate"] == 0.0
    assert 1.0 < lines["paced_rate"] < 12.0
    assert 0.0 < lines["far_rate"] < lines["fast_rate"]
    assert lines["fast_rate"] > 10.0
    assert lines["followers_slowest_rate"] > 0.5 * lines["followers_fastest_rate"]
    assert lines["memory_growth"] < 100.0
    # a dead viewer on which publishing waited would hold it for 15 s; how little it is the kept figures tell,
    # for a busy machine takes the processor away from whoever measures
    assert lines["longest_publish_wait_followers"] < 1000.0
    assert lines["cpu_per_step_with_to_without"] < 2.0
