import pytest

from viewer.world import Bracket, WaterTimeline


@pytest.fixture
def timeline() -> WaterTimeline:
    line = WaterTimeline(20.0)
    for index in (3, 0, 1, 2, 7):
        line.add(index)
    return line


def test_indices_are_kept_in_order_and_once(timeline: WaterTimeline) -> None:
    timeline.add(3)

    assert timeline.indices == (0, 1, 2, 3, 7)
    assert (timeline.first_time, timeline.last_time) == (0.0, 140.0)


def test_a_time_between_two_frames_is_bracketed(timeline: WaterTimeline) -> None:
    assert timeline.bracket(25.0) == Bracket(1, 2, pytest.approx(0.25))


def test_a_gap_is_bridged_by_its_neighbours(timeline: WaterTimeline) -> None:
    assert timeline.bracket(100.0) == Bracket(3, 7, pytest.approx(0.5))


def test_a_frame_time_shows_that_frame_alone(timeline: WaterTimeline) -> None:
    bracket = timeline.bracket(40.0)

    assert bracket is not None
    assert (bracket.first, bracket.alpha) == (2, 0.0)


def test_before_and_after_the_known_the_end_frames_stand(timeline: WaterTimeline) -> None:
    timeline.discard(0)

    assert timeline.bracket(5.0) == Bracket(1, 1, 0.0)
    assert timeline.bracket(900.0) == Bracket(7, 7, 0.0)


def test_no_frame_no_bracket() -> None:
    assert WaterTimeline(20.0).bracket(5.0) is None


def test_a_recalculation_drops_the_future(timeline: WaterTimeline) -> None:
    timeline.drop_from(2)

    assert timeline.indices == (0, 1)
    assert 2 not in timeline


def test_the_frame_of_recalculation_is_the_last_at_or_before_the_time() -> None:
    line = WaterTimeline(0.1)

    assert [line.index_before(t) for t in (0.0, 0.05, 0.3, 0.7, 0.75)] == [0, 0, 3, 7, 7]


def test_an_interval_of_none_is_refused() -> None:
    with pytest.raises(ValueError, match="interval"):
        WaterTimeline(0.0)
