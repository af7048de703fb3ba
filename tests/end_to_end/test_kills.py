"""A small dose of `python -m bench kills`, whose full count is kept in bench/results."""

from pathlib import Path

import protocol
from bench.kills import Tally, Watched, _check, kill_again_and_again
from bench.service_process import ServiceClient, ServiceProcess


def test_no_acknowledged_edit_or_frame_is_lost_by_five_kills_and_the_run_ends_with_the_very_bytes(
    tmp_path: Path, case: str
) -> None:
    tally = kill_again_and_again(tmp_path, 5, case=case, seed=3, cases=[case], threads=2)
    assert sum(tally.kills.values()) == 5
    assert tally.finished_runs >= 1
    assert tally.received_frames > 0
    assert (tally.lost_edits, tally.lost_frames, tally.different_frames) == (0, 0, 0)


def test_an_edit_or_a_frame_that_is_not_there_is_counted(service: ServiceProcess, case: str) -> None:
    tally = Tally()
    with ServiceClient(service) as client:
        run = str(client.do(protocol.StartRun, case=case, paused=True)["run"])
        client.do(protocol.Subscribe, run=run)
        client.frame(run, 0)
        _check(client, Watched(run, ["never-stored"], {0: b"other bytes", 7: b"never computed"}), tally)
    assert (tally.lost_edits, tally.lost_frames) == (1, 2)
