from viewer.app.recalculation import Recalculation


def begun() -> Recalculation:
    return Recalculation("parent", 10, (), pressed_at=100.0, follows_live=False)


def test_frames_of_the_parent_end_nothing() -> None:
    made = begun()
    made.child = "child"

    assert not made.note_painted((("parent", 9),), 101.0)
    assert made.is_waiting


def test_nothing_counts_before_the_child_is_named() -> None:
    assert not begun().note_painted((("child", 10),), 101.0)


def test_the_first_frame_and_the_next_one_are_timed_from_the_press() -> None:
    made = begun()
    made.child = "child"

    assert made.note_painted((("child", 10),), 100.4)
    assert not made.is_waiting
    assert not made.note_painted((("child", 10),), 100.6)
    assert made.note_painted((("child", 10), ("child", 11)), 101.0)
    assert made.first_frame_s is not None
    assert made.next_frame_s is not None
    assert round(made.first_frame_s, 6) == 0.4
    assert round(made.next_frame_s, 6) == 1.0
