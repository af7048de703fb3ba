import asyncio

from solver_service.web.outbox import Outbox


def drained(outbox: Outbox) -> list[bytes]:
    found = []
    while (packet := outbox.next()) is not None:
        found.append(packet)
    return found


def test_control_goes_between_the_parts_of_something_large() -> None:
    outbox = Outbox()
    outbox.put_bulk([b"part 0", b"part 1"])
    first = outbox.next()
    outbox.put([b"ack"])
    assert [first, *drained(outbox)] == [b"part 0", b"ack", b"part 1"]


def test_large_things_count_until_their_last_part_is_taken() -> None:
    outbox = Outbox()
    outbox.put_bulk([b"a", b"b"])
    outbox.put_bulk([b"c"])
    assert outbox.bulk_count == 2
    assert [outbox.next(), outbox.next(), outbox.next()] == [b"a", b"b", b"c"]
    assert outbox.bulk_count <= 1
    assert outbox.next() is None
    assert outbox.bulk_count == 0


def test_too_many_unread_messages_close_the_connection_with_a_reason() -> None:
    outbox = Outbox(max_messages=3)
    outbox.put([b"a", b"b", b"c"])
    assert outbox.closing is None
    outbox.put([b"d"])
    assert outbox.closing == (1013, "4 messages of 4 bytes were left unread")
    assert drained(outbox) == []


def test_too_many_unread_bytes_close_the_connection_with_a_reason() -> None:
    outbox = Outbox(max_bytes=10)
    outbox.put([b"x" * 11])
    assert outbox.closing == (1013, "1 messages of 11 bytes were left unread")


def test_what_is_said_before_a_close_is_sent_and_bulk_is_not() -> None:
    outbox = Outbox()
    outbox.put_bulk([b"part"])
    outbox.put([b"error"])
    outbox.close(1008, "first")
    outbox.close(1001, "second")
    assert drained(outbox) == [b"error"]
    assert outbox.closing == (1008, "first")


def test_a_waiting_sender_is_woken_by_every_kind_of_news() -> None:
    async def scenario() -> None:
        outbox = Outbox()
        for news in (
            lambda: outbox.put([b"a"]),
            lambda: outbox.put_bulk([b"b"]),
            outbox.wake,
            lambda: outbox.close(1000, "end"),
        ):
            waiter = asyncio.ensure_future(outbox.wait())
            await asyncio.sleep(0)
            assert not waiter.done()
            news()
            await asyncio.wait_for(waiter, 1.0)

    asyncio.run(scenario())
