import random

from viewer.net import BackOff


def test_waiting_times_double_up_to_the_longest() -> None:
    back_off = BackOff(first_s=0.5, longest_s=4.0, jitter=0.0)

    assert [back_off.next_delay() for _ in range(5)] == [0.5, 1.0, 2.0, 4.0, 4.0]


def test_the_attempts_are_counted_and_start_over_after_success() -> None:
    back_off = BackOff(first_s=1.0, jitter=0.0)
    back_off.next_delay()
    back_off.next_delay()
    assert back_off.attempt == 2
    back_off.reset()

    assert back_off.next_delay() == 1.0


def test_jitter_takes_away_at_most_its_share() -> None:
    back_off = BackOff(first_s=1.0, longest_s=1.0, jitter=0.3, source=random.Random(1))
    delays = [back_off.next_delay() for _ in range(200)]

    assert min(delays) >= 0.7
    assert max(delays) <= 1.0
    assert max(delays) - min(delays) > 0.2
