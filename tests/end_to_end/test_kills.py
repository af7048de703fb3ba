"""A small dose of `python -m bench kills`, whose full count is kept in bench/results."""

from pathlib import Path

from bench.kills import kill_again_and_again


def test_no_acknowledged_edit_or_frame_is_lost_by_five_kills_and_the_run_ends_with_the_very_bytes(
    tmp_path: Path, case: str
) -> None:
    tally = kill_again_and_again(tmp_path, 5, case=case, seed=3, cases=[case], threads=2)
    assert sum(tally.kills.values()) == 5
    assert tally.finished_runs >= 1
    assert tally.received_frames > 0
    assert (tally.lost_edits, tally.lost_frames, tally.different_frames) == (0, 0, 0)
