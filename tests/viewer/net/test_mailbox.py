import threading

import pytest

from viewer.net import Mailbox, MailboxFull


def test_control_messages_come_out_in_the_order_they_went_in() -> None:
    box: Mailbox[int, int] = Mailbox()
    for number in range(5):
        box.put_control(number)

    assert box.take_control() == [0, 1, 2, 3, 4]
    assert box.take_control() == []


def test_control_is_never_dropped_but_refused_when_full() -> None:
    box: Mailbox[int, int] = Mailbox(control_limit=2)
    box.put_control(1)
    box.put_control(2)

    with pytest.raises(MailboxFull):
        box.put_control(3)
    assert box.take_control() == [1, 2]


def test_the_oldest_frame_gives_way_to_the_newest() -> None:
    box: Mailbox[int, int] = Mailbox(frame_limit=3)
    for number in range(5):
        box.put_frame(number)

    assert box.take_frames() == [2, 3, 4]
    assert box.dropped_frames == 2


def test_frames_can_be_taken_a_few_at_a_time() -> None:
    box: Mailbox[int, int] = Mailbox()
    for number in range(5):
        box.put_frame(number)

    assert box.take_frames(2) == [0, 1]
    assert box.take_frames() == [2, 3, 4]


def test_waiting_ends_when_another_thread_puts_something_in() -> None:
    box: Mailbox[int, int] = Mailbox()
    assert not box.wait(0.01)
    putter = threading.Timer(0.05, box.put_frame, (1,))
    putter.start()

    assert box.wait(5.0)
    putter.join()


def test_every_message_of_many_threads_arrives_once() -> None:
    box: Mailbox[int, int] = Mailbox()
    putters = [
        threading.Thread(target=lambda base=base: [box.put_control(base + k) for k in range(100)])
        for base in (0, 1000, 2000)
    ]
    for putter in putters:
        putter.start()
    for putter in putters:
        putter.join()

    assert sorted(box.take_control()) == [base + k for base in (0, 1000, 2000) for k in range(100)]
