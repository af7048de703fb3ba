"""The comparison with other solvers, none installed: the case, the errors, what is skipped and why."""

import sys
from dataclasses import replace

import pytest

from bench.__main__ import names
from bench.peers import case, environments, figure_of, measures, table
from bench.peers.environments import PEERS, Peer, PeerMissing
from bench.peers.measures import Outcome, coarsen, errors, run

FEV = PEERS[0]


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    return run(sys.executable, FEV, 32, tmp_path_factory.mktemp("peers"))


def test_packages_and_modules_are_benches():
    assert {"peers", "solver_step"} <= set(names())
    assert "machine" not in names()


def test_case_is_the_same_flood_on_every_grid():
    volumes = [case.depth(*case.centres(cells)).mean() * case.SIDE**2 for cells in (512, 1024, 2048)]
    assert volumes[0] == pytest.approx(volumes[2], rel=1e-4)
    x, y = case.centres(256)
    bed, depth = case.bed(x, y), case.depth(x, y)
    assert (bed + depth).max() == pytest.approx(case.SURFACE)
    assert (depth == 0.0).mean() > 0.5
    assert bed.min() > 0.25
    assert bed.max() < 0.75


def test_solver_runs_the_case_in_a_process_of_its_own(outcome):
    assert outcome.h.shape == (32, 32)
    assert outcome.steps > 10
    assert outcome.cpu_s > 0.0
    assert abs(outcome.volume_error) < 1e-6
    began = case.depth(*case.centres(32))
    assert outcome.h.sum() == pytest.approx(began.sum(), rel=1e-6)
    assert (outcome.h > measures.DEPTH_WET).sum() > (began > measures.DEPTH_WET).sum()


def test_errors_are_none_against_itself_and_grow_with_the_difference(outcome):
    assert set(errors(outcome, outcome).values()) == {0.0}
    deeper = replace(outcome, h=outcome.h + 0.25)
    assert errors(deeper, outcome)["error_h_m"] == pytest.approx(0.25)
    assert errors(deeper, outcome)["wrongly_wet_or_dry"] > 0.0


def test_fine_run_is_averaged_over_the_common_cells(outcome):
    coarse = coarsen(outcome, 8)
    assert coarse.h.shape == (8, 8)
    assert coarse.h[0, 1] == pytest.approx(outcome.h[0:4, 4:8].mean())
    assert coarse.cell_steps == 64 * outcome.steps


def test_peer_without_its_interpreter_or_tool_says_which(monkeypatch, tmp_path):
    monkeypatch.setattr(environments, "FOLDER", tmp_path)
    with pytest.raises(PeerMissing, match=r"needs the interpreter python3\.99"):
        environments.python_of(Peer("old", "fev", "", ("nothing",), python="3.99"))
    with pytest.raises(PeerMissing, match="needs no-such-compiler to be built"):
        environments.python_of(Peer("built", "fev", "", ("nothing",), tools=("no-such-compiler",)))
    assert not list(tmp_path.iterdir())


def test_peer_that_pip_cannot_install_is_skipped_with_its_last_words(monkeypatch, tmp_path):
    monkeypatch.setattr(environments, "FOLDER", tmp_path)
    nowhere = str(tmp_path / "no_such_folder")
    with pytest.raises(PeerMissing, match="pip could not install broken: "):
        environments.python_of(Peer("broken", "fev", "", (nowhere,)))


def test_run_that_fails_is_told_with_its_last_line(tmp_path):
    with pytest.raises(PeerMissing, match=r"its run failed: .*no_such_script"):
        run(sys.executable, Peer("lost", "no_such_script", ""), 8, tmp_path)


def test_table_lists_speed_errors_and_what_was_skipped(outcome):
    reference = Outcome(outcome.h + 0.01, outcome.hu, outcome.hv, 1, 1.0, 1.0, 0.0, "x")
    machine = {"cpu": "some processor", "system": "some system", "commit": "abc"}
    lines = [
        {"figure": "A less B", "value": 0.002, "unit": "m", "machine": machine, "date": "2026-01-01"},
        figure_of("FEV", "scheme", outcome, {"fine": reference}),
        {"figure": "gone", "skipped": "needs gfortran to be built"},
    ]
    text = table.render(lines)
    assert "error of h against fine [mm]" in text
    assert "| 10.0 |" in text
    assert "skipped: needs gfortran to be built" in text
    assert "A less B: 2.0 mm on average." in text
    assert len({row.count("|") for row in text.splitlines() if row.startswith("|")}) == 1
