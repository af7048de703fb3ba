"""The headless session on the tiny service."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.viewer.tiny_service import INTERVAL, TOKEN, TinyService
from viewer.app.headless import HeadlessError, HeadlessSession
from viewer.app.script import ScriptStep
from viewer.app.viewer_app import ViewerApp
from viewer.commands import CommandError, FinishEdit, Pause, Seek, StartRun
from viewer.net import ConnectionThread, FrameLoader


@pytest.fixture
def session(tmp_path: Path) -> Iterator[HeadlessSession]:
    service = TinyService(computed=20)
    connection = ConnectionThread(service.url, TOKEN)
    app = ViewerApp(connection, FrameLoader(), StartRun("tiny"))
    connection.start()
    made = HeadlessSession(app, tmp_path / "out", (320, 180))
    yield made
    made.close()
    app.close()
    service.close()


def test_a_picture_shows_the_time_it_was_asked_for(session: HeadlessSession) -> None:
    session.wait_computed(10 * INTERVAL, 10.0)
    session.app.carry_out(Pause())
    session.app.carry_out(Seek(2 * INTERVAL))
    early = session.picture("early.png")
    session.app.carry_out(Seek(10 * INTERVAL))
    late = session.picture("late.png")
    session.app.carry_out(Seek(2 * INTERVAL))
    again = session.picture("again.png")

    assert (early != late).any()
    np.testing.assert_array_equal(early[60:, 120:], again[60:, 120:])
    assert session.pictures == ["early.png", "late.png", "again.png"]
    with Image.open(session.folder / "late.png") as written:
        np.testing.assert_array_equal(np.asarray(written), late)
    assert session.first_picture_at is not None


def test_waiting_in_vain_ends_with_what_was_waited_for(session: HeadlessSession) -> None:
    with pytest.raises(HeadlessError, match=r"in vain for the moon"):
        session.pump(lambda: False, "the moon", 0.1)


def test_a_script_waits_carries_out_and_takes_pictures(session: HeadlessSession) -> None:
    session.follow(
        [
            ScriptStep(until_time=15 * INTERVAL, command=Pause()),
            ScriptStep(at_wall=0.1, command=Seek(12 * INTERVAL), picture="twelve.png"),
        ]
    )

    assert session.app.clock.time == 12 * INTERVAL
    assert session.pictures == ["twelve.png"]


def test_a_step_that_makes_no_sense_ends_the_script(session: HeadlessSession) -> None:
    with pytest.raises(CommandError, match="at least two points"):
        session.follow([ScriptStep(command=FinishEdit()), ScriptStep(picture="never.png")])

    assert session.pictures == []


def test_who_watches_can_end_the_waiting(tmp_path: Path, session: HeadlessSession) -> None:
    def watch() -> None:
        raise HeadlessError("the service ended")

    session._watch = watch
    with pytest.raises(HeadlessError, match="the service ended"):
        session.pump(lambda: False, "anything", 5.0)
