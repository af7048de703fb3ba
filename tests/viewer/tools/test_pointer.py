import dataclasses

import pytest

from viewer.tools import PointerEvent


def test_an_event_cannot_be_changed_after_it_happened() -> None:
    event = PointerEvent("press", 0.1, 0.2, "left")

    with pytest.raises(dataclasses.FrozenInstanceError):
        event.x = 0.5  # type: ignore[misc]


def test_an_event_is_over_nothing_until_the_ground_was_looked_up() -> None:
    assert PointerEvent("move", 0.1, 0.2).ground is None
