"""The bench of GPUs: what it says without one, and that all of it runs, on the CPU by the GPU engine."""

import pytest

from bench import gpu
from solver_service.numerics import device_names


def test_without_a_gpu_one_line_says_so(monkeypatch):
    monkeypatch.setattr(gpu, "device_names", lambda: ["cpu"])
    (line,) = gpu.figures(smoke=True)
    assert line["value"] == 0
    assert "nothing measured" in line["case"]


def test_cpu_and_tiles_agree_in_every_array_with_everything_on():
    lines = {line["figure"]: line for line in gpu.agreement("cpu", 48, engine="tiles")}
    assert lines["arrays_in_which_cpu_and_gpu_differ"]["value"] == 0, lines
    assert lines["arrays_that_a_split_run_changes"]["value"] == 0, lines


def test_an_interval_is_one_launch_and_questions_are_asked():
    lines = {line["figure"]: line["value"] for line in gpu.waiting("cpu", 32, engine="tiles")}
    assert lines["graph_launches_per_interval"] == 1
    assert lines["longest_wait_for_a_question"] > 0.0


def test_every_rate_is_measured():
    lines = list(gpu.rates("cpu", 32))
    assert len(lines) == 8
    assert all(line["value"] > 0.0 for line in lines)


@pytest.mark.gpu
def test_cpu_and_gpu_agree_within_the_stated_bound():
    devices = device_names()[1:]
    if not devices:
        pytest.skip("no CUDA device")
    for line in gpu.agreement(devices[0], 256):
        if str(line["figure"]).startswith("cpu_gpu_difference") or "split" in str(line["figure"]):
            assert line["value"] <= line["floor"], line
