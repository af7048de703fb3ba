import threading
import time
from multiprocessing import Pipe

from solver_service.runs.inbox import Inbox
from solver_service.runs.worker_messages import Quit


def test_commands_come_in_the_order_in_which_they_were_sent() -> None:
    service, worker = Pipe()
    inbox = Inbox(worker)
    service.send("first")
    service.send("second")

    assert inbox.next(wait=True) == "first"
    assert inbox.next(wait=True) == "second"
    assert inbox.next(wait=False) is None
    service.close()


def test_a_command_that_waits_is_seen_without_taking_it() -> None:
    service, worker = Pipe()
    inbox = Inbox(worker)
    assert not inbox.pending
    service.send("pause")
    deadline = time.monotonic() + 5.0
    while not inbox.pending and time.monotonic() < deadline:
        time.sleep(0.001)

    assert inbox.pending
    assert inbox.next(wait=False) == "pause"
    service.close()


def test_every_look_counts_and_waiting_is_told() -> None:
    service, worker = Pipe()
    inbox = Inbox(worker)
    seen = []
    for look in (lambda: inbox.pending, lambda: inbox.quitting, lambda: inbox.next(wait=False)):
        look()
        seen.append((inbox.looks, inbox.is_waited_for))
    assert seen == [(1, False), (2, False), (3, False)]
    waiting = threading.Thread(target=inbox.next, args=(True,))
    waiting.start()
    deadline = time.monotonic() + 5.0
    while not inbox.is_waited_for and time.monotonic() < deadline:
        time.sleep(0.001)
    assert inbox.is_waited_for
    service.send("go on")
    waiting.join(5.0)
    assert not inbox.is_waited_for
    service.close()


def test_a_service_that_is_gone_means_quit() -> None:
    service, worker = Pipe()
    inbox = Inbox(worker)
    service.close()

    assert isinstance(inbox.next(wait=True), Quit)
