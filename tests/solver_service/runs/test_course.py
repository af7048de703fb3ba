import pytest

from solver_service.runs.course import Course, next_index_after
from solver_service.runs.lineage import Leg
from solver_service.runs.worker_messages import Begin


def course(position: int, stored_end: int) -> Course:
    legs = (Leg("r1", 0, 0, b"", b""), Leg("r2", 6, 1, b"", b""))
    begin = Begin("r2", "case", "f00d", "cpu", legs, 5.0, 20)
    return Course(begin, position=position, stored_end=stored_end)


@pytest.mark.parametrize(
    ("position", "stored_end", "time", "index"),
    [
        (0, 6, 0.0, 1),  # a replay from the beginning lands on every frame time
        (0, 6, 12.3, 3),
        (0, 6, 25.0, 6),
        (0, 6, 30.0, 6),  # the branch point itself: its bed must still be laid
        (1, 9, 30.0, 7),
        (1, 9, 45.0, 9),  # the state of a frame that is not stored yet
        (1, 9, 46.0, 10),
    ],
)
def test_the_next_frame_time_is_the_first_after_the_state_or_its_own_where_something_is_due(
    position: int, stored_end: int, time: float, index: int
) -> None:
    assert next_index_after(course(position, stored_end), time) == index


def test_only_the_last_leg_is_its_own() -> None:
    assert not course(0, 6).is_own
    assert course(1, 6).is_own


def test_a_run_lacks_its_first_frame_until_that_is_handed_over() -> None:
    assert course(1, 6).lacks_first_frame
    assert not course(1, 7).lacks_first_frame
