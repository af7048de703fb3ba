"""A wall clock jumps: nothing that decides anything may read it. Stamps and expiry of tokens may."""

import re
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
WALL_CLOCK = re.compile(r"\btime\.time\(\)|\bdatetime\.now\(|\bclock\.time\(\)|\btime_ns\(\)")
STAMPS = {
    "solver_service/cli/token.py",
    "solver_service/store/run_database.py",
    "solver_service/uploads/upload_desk.py",
    "solver_service/uploads/upload_record.py",
    "solver_service/web/overview.py",
    "solver_service/web/stream.py",
    "solver_service/web/token_store.py",
}
"""Modules that write down when something was, and those of tokens, which expire by the calendar."""


def test_only_stamps_and_tokens_read_the_wall_clock() -> None:
    readers = {
        path.relative_to(REPOSITORY).as_posix()
        for path in (REPOSITORY / "solver_service").rglob("*.py")
        if WALL_CLOCK.search(path.read_text(encoding="utf-8"))
    }
    assert readers <= STAMPS
    assert "solver_service/store/run_database.py" in readers, "the pattern finds what it looks for"
