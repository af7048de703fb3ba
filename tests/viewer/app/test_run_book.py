import msgspec

import protocol
from tests.viewer.tiny_service import GRID
from viewer.app.run_book import RunBook


def info(run: str, parent: str | None = None, frames: int = 0) -> protocol.RunInfo:
    return protocol.RunInfo(
        run=run,
        case="tiny",
        title="Tiny valley",
        status="running",
        grid=protocol.GridInfo.from_geometry(GRID),
        duration=390.0,
        output_interval=10.0,
        frame_count=frames,
        device="cpu",
        hypothetical=True,
        depth_wet=0.001,
        parent=parent,
        branch_index=None if parent is None else 4,
    )


def edit(name: str) -> protocol.EditLine:
    return protocol.EditLine(
        id=name,
        vertices=((1100.0, 2100.0), (1200.0, 2100.0)),
        width=20.0,
        operation=protocol.Operation.raise_,
        type=protocol.EditType.modulate,
        magnitude=2.0,
    )


def test_the_frame_count_never_goes_back() -> None:
    book = RunBook()
    book.note_run(info("a", frames=3))
    book.note_frame_count("a", 9)
    book.note_run(info("a", frames=5))

    assert book.runs["a"].frame_count == 10


def test_a_run_without_a_parent_lies_on_the_base_bed_whatever_its_list_holds() -> None:
    book = RunBook()
    book.note_run(info("a"))
    book.note_edits(protocol.EditsChanged("a", 1, (edit("one"),)))

    assert book.edits_below("a", 1) == ()


def test_a_branch_lies_on_the_list_of_its_revision() -> None:
    book = RunBook()
    book.note_run(info("a"))
    book.note_run(info("b", parent="a"))
    book.note_edits(protocol.EditsChanged("a", 1, (edit("one"),)))
    book.note_edits(protocol.EditsChanged("b", 2, (edit("one"), edit("two"))))

    assert [made.id for made in book.edits_below("b", 1)] == ["one"]
    assert [made.id for made in book.edits_below("b", 2)] == ["one", "two"]


def test_what_was_asked_for_here_is_known_for_certain() -> None:
    book = RunBook()
    book.note_run(info("b", parent="a"))
    book.applied["b"] = (edit("one"),)
    book.note_edits(protocol.EditsChanged("b", 5, ()))

    assert [made.id for made in book.edits_below("b", 5)] == ["one"]


def test_rows_hold_what_the_panel_shows() -> None:
    book = RunBook()
    book.note_run(msgspec.structs.replace(info("b", parent="a", frames=8), status="paused"))
    book.cases = (protocol.CaseSummary("tiny", "Tiny valley", True, 10, 20, 5.0, 390.0, 10.0),)
    (row,) = book.run_rows()
    (case,) = book.case_rows()

    assert (row.branch_time, row.computed_until, row.status) == (40.0, 70.0, "paused")
    assert (case.cells, case.hypothetical) == (200, True)
