import protocol
from tests.viewer.app.test_run_book import edit, info
from tests.viewer.tiny_service import valley
from viewer.app.edit_drawing import EditDrawing
from viewer.app.levee_watch import LeveeWatch
from viewer.app.picture_text import edit_overlay, edit_rows, hud_text, loss_notice, readout
from viewer.app.recalculation import Recalculation
from viewer.app.shown_run import ShownRun
from viewer.net import FrameLoader
from viewer.render import LineStyle
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


def test_the_line_being_drawn_lies_on_the_ground_with_the_edits() -> None:
    run = shown(info("a"))
    drawing = EditDrawing()
    assert edit_overlay(run, drawing) is None
    run.document.mirror(1, [edit("one")], True, False)
    drawing.begin()
    drawing.vertices = [(1100.0, 2100.0)]
    drawing.hover = (1200.0, 2200.0)
    overlay = edit_overlay(run, drawing)

    assert overlay is not None
    assert [line.style for line in overlay.lines] == [LineStyle.RAISE, LineStyle.DRAFT]
    assert overlay.lines[1].vertices == ((1100.0, 2100.0), (1200.0, 2200.0))
    assert overlay.sign.max() == 1


def test_an_edit_counts_as_computed_only_when_the_run_has_it() -> None:
    run = shown(info("a"))
    run.document.mirror(1, [edit("one"), edit("two")], True, False)
    rows = edit_rows(run, [edit("one")], LeveeWatch())

    assert [(row.id, row.is_applied, row.warning) for row in rows] == [("one", True, ""), ("two", False, "")]
    assert all(" m long, " in row.measure and row.measure.endswith(" m\u00b3 of fill") for row in rows)


def test_a_reading_becomes_a_readout() -> None:
    assert readout(None) is None
    made = readout(ProbeReading(1.0, 2.0, 3, 4, 10.0, 0.5, 10.5))

    assert made is not None
    assert (made.ground, made.depth, made.level) == (10.0, 0.5, 10.5)
