import msgspec
import numpy as np
import pytest

import protocol
from tests.viewer.app.test_run_book import edit, info
from tests.viewer.tiny_service import valley
from viewer.app.shown_run import ShownRun
from viewer.net import FrameLoader
from viewer.world import MovedBed


def branch() -> protocol.RunInfo:
    lineage = tuple(protocol.LineageEntry(run, at) for run, at in (("a", 0), ("b", 4), ("c", 9)))
    return msgspec.structs.replace(info("c", parent="b", frames=12), lineage=lineage)


@pytest.fixture
def loader() -> FrameLoader:
    return FrameLoader()


def test_a_frame_index_belongs_to_the_youngest_run_that_began_by_then(loader: FrameLoader) -> None:
    shown = ShownRun(branch(), valley(), loader)

    assert [shown.frame_key(index)[0] for index in (0, 3, 4, 8, 9, 30)] == ["a", "a", "b", "b", "c", "c"]
    assert (shown.root, shown.branch_index) == ("a", 9)
    loader.close()


def test_only_frames_of_the_lineage_count(loader: FrameLoader) -> None:
    shown = ShownRun(branch(), valley(), loader)

    assert shown.note_frame(("b", 5))
    assert not shown.note_frame(("a", 5))
    assert not shown.note_frame(("x", 5))
    assert shown.timeline.indices == (5,)
    assert shown.next_missing(5) == 6
    shown.discard_frames("a", [5])
    assert shown.timeline.indices == (5,)
    shown.discard_frames("b", [5])
    assert shown.timeline.indices == ()
    loader.close()


def test_the_ground_follows_the_edits(loader: FrameLoader) -> None:
    shown = ShownRun(branch(), valley(), loader)
    assert not shown.refresh_ground()
    shown.document.mirror(1, [edit("one")], True, False)

    assert shown.refresh_ground()
    assert shown.heightfield.z_b.max() >= valley().max()
    assert (shown.heightfield.z_b != valley()).any()
    assert not shown.refresh_ground()
    loader.close()


def test_a_branch_goes_on_with_the_ground_of_its_parent_and_corrects_it(loader: FrameLoader) -> None:
    parent = ShownRun(info("a"), valley(), loader)
    parent.document.mirror(1, [edit("one")], True, False)
    parent.refresh_ground()
    child = ShownRun(branch(), valley(), loader, parent.heightfield)
    child.refresh_ground()

    assert child.heightfield is parent.heightfield
    np.testing.assert_array_equal(child.heightfield.z_b, valley())
    assert child.overlay_revision() != parent.overlay_revision()
    loader.close()


def test_what_is_computed_counts_even_before_it_has_come(loader: FrameLoader) -> None:
    shown = ShownRun(branch(), valley(), loader)

    assert shown.computed_until == 110.0
    loader.close()


def test_ground_that_was_previewed_but_never_drawn_is_put_right(loader: FrameLoader) -> None:
    shown = ShownRun(info("a"), valley(), loader)
    texture, revision = valley(), shown.heightfield.revision  # what a renderer keeps of the ground
    for x in (1700.0, 1500.0, 1300.0):
        line = msgspec.structs.replace(edit("draft"), vertices=((1100.0, 2100.0), (x, 2600.0)))
        shown.document.set_draft(line)
        if x == 1500.0:
            shown.overlay_revision()  # a picture looks at the preview between two refreshes
            continue
        shown.refresh_ground()
        dirty = shown.heightfield.changed_since(revision)
        assert dirty is not None
        row0, col0, row1, col1 = dirty
        texture[row0:row1, col0:col1] = shown.heightfield.z_b[row0:row1, col0:col1]
        revision = shown.heightfield.revision

    np.testing.assert_array_equal(texture, shown.document.preview().z_b)
    loader.close()


def gap(depth: float) -> MovedBed:
    cells = np.array([20 * 96 + 30, 20 * 96 + 31, 22 * 96 + 30], np.int64)
    before = valley().ravel()[cells]
    return MovedBed(cells, before - np.float32(depth), before)


def test_a_breach_lies_on_the_ground_at_its_time_and_is_gone_before_it(loader: FrameLoader) -> None:
    shown = ShownRun(info("a"), valley(), loader)
    breach = gap(2.0)

    assert shown.refresh_ground(breach)
    assert shown.heightfield.z_b.ravel()[breach.cells].tolist() == breach.z_b.tolist()
    assert (shown.heightfield.z_b != valley()).sum() == 3
    assert not shown.refresh_ground(breach)
    assert shown.refresh_ground(gap(3.0))
    assert shown.heightfield.z_b[20, 30] == valley()[20, 30] - np.float32(3.0)
    assert shown.refresh_ground(None)
    np.testing.assert_array_equal(shown.heightfield.z_b, valley())
    loader.close()


def test_a_breach_stays_when_an_edit_is_drawn_elsewhere_or_over_it(loader: FrameLoader) -> None:
    shown = ShownRun(info("a"), valley(), loader)
    breach = gap(2.0)
    shown.refresh_ground(breach)
    shown.document.mirror(1, [edit("one")], True, False)

    assert shown.refresh_ground(breach)
    expected = shown.document.preview().z_b.copy()
    expected.ravel()[breach.cells] = breach.on(expected.ravel()[breach.cells])
    np.testing.assert_array_equal(shown.heightfield.z_b, expected)
    shown.document.mirror(2, [], False, True)
    shown.refresh_ground(None)
    np.testing.assert_array_equal(shown.heightfield.z_b, valley())
    loader.close()
