import pytest

from viewer.view_status import ViewStatus, time_text


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
