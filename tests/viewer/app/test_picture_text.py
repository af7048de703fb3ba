import protocol
from tests.viewer.app.test_run_book import info
from tests.viewer.tiny_service import valley
from viewer.app.picture_text import hud_text, loss_notice, readout
from viewer.app.recalculation import Recalculation
from viewer.app.shown_run import ShownRun
from viewer.net import FrameLoader
from viewer.world import ProbeReading


def shown(run: protocol.RunInfo) -> ShownRun:
    loader = FrameLoader()
    made = ShownRun(run, valley(), loader)
    loader.close()
    return made


def test_the_picture_says_what_it_shows_and_that_it_never_happened() -> None:
    text = hud_text(shown(info("a", frames=4)), 25.0, None, None, "connection lost")

    assert (text.title, text.time, text.notice) == ("Tiny valley", "00:00:25", "connection lost")
    assert text.is_hypothetical
    assert "computed until 00:00:30 on cpu" in text.detail


def test_a_loss_is_told_with_the_age_of_the_picture_once_there_was_one() -> None:
    assert loss_notice("no connection", 75.4) == "no connection\nThis picture is 00:01:15 old."
    assert loss_notice("no connection", None) == "no connection"


def test_a_branch_says_from_when_and_how_fast_it_came() -> None:
    begun = Recalculation("a", 4, (), 0.0, False, child="b", first_frame_s=0.375)
    progress = protocol.Progress("b", 60.0, 100, 0.5, 43.0, 1.4, 1e6, 2.5e-8, 10)
    text = hud_text(shown(info("b", parent="a")), 45.0, progress, begun, "")

    assert "recalculated from 00:00:40, first frame after 0.38 s" in text.detail
    assert "43 x real time, volume error 2.5e-08" in text.detail


def test_a_reading_becomes_a_readout() -> None:
    assert readout(None) is None
    made = readout(ProbeReading(1.0, 2.0, 3, 4, 10.0, 0.5, 10.5))

    assert made is not None
    assert (made.ground, made.depth, made.level) == (10.0, 0.5, 10.5)
