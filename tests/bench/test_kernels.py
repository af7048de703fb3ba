"""The report of the compiled kernels, and the reader of cubin files behind it."""

import pytest

from bench import cubin, kernels
from bench.cubin import CompiledKernel


def test_the_report_names_the_step_and_keeps_it_within_its_floor():
    lines = {line["figure"]: line for line in kernels.figures(smoke=True)}
    step = lines["sm_90_step_listed_tiles"]
    assert step["value"] <= step["floor"]
    assert step["blocks_at_once"] >= 4
    assert step["stack_bytes"] == step["spill_instructions"] == 0
    assert step["instructions"]["float"] > 300
    assert step["instructions"]["barrier"] == 6
    assert len(lines) > 15


@pytest.mark.parametrize(
    ("registers", "shared", "architecture", "blocks"),
    [(64, 0, 90, 4), (65, 0, 90, 3), (32, 0, 80, 8), (32, 40_000, 80, 4), (32, 40_000, 90, 5)],
)
def test_blocks_at_once_are_bounded_by_registers_shared_memory_and_threads(
    registers, shared, architecture, blocks
):
    kernel = CompiledKernel("k", registers, 0, shared, ())
    assert cubin.blocks_at_once(kernel, architecture) == blocks


def test_a_file_that_is_no_cubin_is_refused(tmp_path):
    file = tmp_path / "x.cubin"
    file.write_bytes(b"hello")
    with pytest.raises(ValueError, match="is not a cubin file"):
        cubin.read_cubin(file)
