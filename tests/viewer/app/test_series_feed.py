from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import protocol
from protocol.series_codec import encode_series
from viewer.app.series_feed import LOST_AFTER_S, PAUSE_S, REFUSED_PAUSE_S, SeriesFeed


class Desk:
    """Takes requests down; the test answers them."""

    is_open = True

    def __init__(self) -> None:
        self.book = SimpleNamespace(runs={"r": SimpleNamespace(frame_count=3)})
        self.asked: list[tuple[str, int]] = []
        self.refuse: Any = None
        self.series_came: Any = None

    def fetch_series(self, run: str, from_index: int, numbered: Any, refused: Any) -> None:
        self.asked.append((run, from_index))
        self.refuse = refused
        numbered(len(self.asked))

    def answer(self, index: int, *times: float, gauges: tuple[str, ...] = ("town",)) -> None:
        count = len(times)
        values = np.zeros((count, len(gauges), 4), dtype=np.float32)
        values[..., 0] = np.asarray(times)[:, None]
        values[..., 2], values[..., 3] = 3.0, 4.0
        passed = np.full((count, 1, 3), 7.0)
        series = protocol.DecodedSeries("r", index, np.array(times), gauges, values, ("wall",), passed)
        self.series_came(protocol.SeriesReceived(len(self.asked), encode_series(series)))


@pytest.fixture
def desk() -> Desk:
    return Desk()


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def feed(desk: Desk, said: list[str]) -> SeriesFeed:
    return SeriesFeed(desk, said.append)  # type: ignore[arg-type]


def follow(feed: SeriesFeed, now: float, *runs: str) -> None:
    feed.follow(tuple(SimpleNamespace(run=run) for run in runs or ("r",)), now)  # type: ignore[arg-type]


def test_only_what_is_new_is_asked_for_and_joined_to_what_is_known(desk: Desk, feed: SeriesFeed) -> None:
    follow(feed, 0.0)
    follow(feed, 1.0)
    assert desk.asked == [("r", 0)], "one at a time"
    desk.answer(2, 0.0, 10.0)
    follow(feed, 2.0)
    assert desk.asked == [("r", 0)], "there is no newer frame"
    desk.book.runs["r"].frame_count = 5
    follow(feed, 3.0)
    desk.answer(4, 20.0)

    assert desk.asked == [("r", 0), ("r", 3)]
    assert feed.record("r", "town", "depth") == ((0.0, 10.0, 20.0), (0.0, 10.0, 20.0))
    assert feed.record("r", "town", "speed") == ((0.0, 10.0, 20.0), (5.0, 5.0, 5.0))
    assert feed.record("r", "wall", "discharge") == ((0.0, 10.0, 20.0), (7.0, 7.0, 7.0))
    assert feed.record("r", "nowhere", "depth") == ((), ())
    assert feed.record("r", "town", "depth") is feed.record("r", "town", "depth")


def test_lost_and_refused_requests_are_made_again_after_a_while(desk: Desk, feed: SeriesFeed) -> None:
    follow(feed, 0.0)
    follow(feed, LOST_AFTER_S - 0.1)
    assert len(desk.asked) == 1
    follow(feed, LOST_AFTER_S)
    assert len(desk.asked) == 2
    desk.refuse("not now")
    again = LOST_AFTER_S + REFUSED_PAUSE_S + PAUSE_S
    follow(feed, again - 0.1)
    assert len(desk.asked) == 2
    follow(feed, again)
    assert len(desk.asked) == 3


def test_series_of_runs_that_are_no_longer_on_show_are_forgotten(desk: Desk, feed: SeriesFeed) -> None:
    follow(feed, 0.0)
    desk.answer(2, 0.0)
    assert feed.record("r", "town", "depth")[0]
    follow(feed, 1.0, "another")
    assert feed.record("r", "town", "depth") == ((), ())


def test_series_that_do_not_fit_are_told_once_and_not_asked_for_again(
    desk: Desk, feed: SeriesFeed, said: list[str]
) -> None:
    follow(feed, 0.0)
    desk.answer(1, 0.0)
    follow(feed, 1.0)
    desk.answer(2, 10.0, gauges=("other",))
    follow(feed, 99.0)

    assert len(said) == 1
    assert "its gauges or sections have changed" in said[0]
    assert len(desk.asked) == 2
