"""A small dose of hostile bytes for every decoder, in a process that may take little memory."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("resource", reason="a limit of memory needs POSIX")

from tests.protocol.decoder_fuzz import DECODERS  # it needs the same

INPUTS = 150
REPOSITORY = Path(__file__).resolve().parents[2]


def fuzzed(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tests.protocol.decoder_fuzz", str(INPUTS), *arguments]
    return subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, timeout=200, check=False)


def test_every_decoder_decodes_or_refuses_in_words_whatever_comes_within_little_memory() -> None:
    answer = fuzzed()
    assert answer.returncode == 0, answer.stderr[-3000:]
    told = {line["decoder"]: line for line in map(json.loads, answer.stdout.splitlines())}
    assert set(told) == set(DECODERS)
    for line in told.values():
        assert 0 < line["refused"] < INPUTS, line  # some of it is no nonsense


def test_a_decoder_that_believes_a_length_is_found_out() -> None:
    answer = fuzzed("--decoder", "naive")
    assert answer.returncode != 0
    assert "MemoryError" in answer.stderr
