"""A small dose of `python -m bench cuts`, whose full count is kept in bench/results."""

import asyncio
from pathlib import Path

import pytest

from bench import cuts


def test_fifty_cuts_at_any_byte_leave_every_viewer_with_the_frames_and_edits_of_the_store(
    tmp_path: Path,
) -> None:
    count, viewers, wrong = asyncio.run(cuts.cut_again_and_again(tmp_path, 50))
    assert count >= 50
    assert viewers > 0
    assert wrong == 0


def test_a_viewer_that_forgets_a_frame_is_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    answer = cuts._answer

    def careless(viewer: cuts.Viewer, client: object, event: object, asked: object) -> list[bytes]:
        sent = answer(viewer, client, event, asked)  # type: ignore[arg-type]
        if 30 in viewer.water:
            viewer.water[30] = b"something else"
        return sent

    monkeypatch.setattr(cuts, "_answer", careless)
    assert asyncio.run(cuts.cut_again_and_again(tmp_path, 1))[2] > 0
