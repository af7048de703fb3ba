"""A history of commands on one working list, and whether some order of them explains every answer.

Every change that is acknowledged gives a revision, so the order is known: the history is linearizable when
the revisions are 1 to n without a gap, an answer that came before another command was sent has the lower
revision, and the changes in that order make the list that the service has in the end.
"""

from dataclasses import dataclass

from protocol import Edit, EditLog


@dataclass(frozen=True)
class Change:
    """A change of the list as a client saw it.

    Attributes:
        kind: "append", "undo" or "redo".
        edit: what was appended.
        revision: what the `ack` gave.
        sent_at: clock when it was sent [s].
        answered_at: clock when it was answered [s].
    """

    kind: str
    edit: Edit | None
    revision: int
    sent_at: float
    answered_at: float


def check_history(changes: list[Change], final: tuple[str, ...]) -> None:
    """Refuse a history that no order explains.

    Raises:
        AssertionError: with what cannot be explained.
    """
    order = sorted(changes, key=lambda change: change.revision)
    assert [change.revision for change in order] == list(range(1, len(order) + 1)), "revisions have gaps"
    for position, change in enumerate(order):
        late = [later for later in order[position + 1 :] if later.answered_at < change.sent_at]
        assert not late, f"revision {change.revision} was asked for after {late[0].revision} was answered"
    log = EditLog()
    for change in order:
        if change.kind == "append":
            assert change.edit is not None
            log.append(change.edit)
        elif change.kind == "undo":
            log.undo()
        else:
            log.redo()
    assert tuple(edit.id for edit in log.edits) == final, "the changes make another list"
