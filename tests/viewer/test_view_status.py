import pytest

from viewer.view_status import ViewStatus, clock_text, time_text


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0.0, "00:00:00"),
        (59.999999999, "00:01:00"),
        (59.4, "00:00:59"),
        (3661.0, "01:01:01"),
        (86_399.0, "23:59:59"),
        (86_400.0, "1d 00:00:00"),
        (1_000_000.0, "11d 13:46:40"),
    ],
)
def test_a_time_is_written_with_days_only_where_there_are_any(seconds: float, text: str) -> None:
    assert time_text(seconds) == text


def test_equal_states_compare_equal_so_that_panels_need_not_be_redrawn() -> None:
    assert ViewStatus(time=1.0) == ViewStatus(time=1.0)
    assert ViewStatus(time=1.0) != ViewStatus(time=2.0)


def test_the_clock_goes_on_over_midnight_in_the_zone_of_the_case() -> None:
    assert clock_text("2024-07-01T23:30:00+02:00", 3600.0) == "2024-07-02 00:30:00 +0200"


@pytest.mark.parametrize("start_time", [None, "", "yesterday", "9999-12-31T23:59:59+00:00"])
def test_a_case_without_a_clock_shows_none(start_time: str | None) -> None:
    assert clock_text(start_time, 3600.0) == ""
