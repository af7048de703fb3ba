import sys

import pytest

from viewer.app.display import has_display


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux names its display")
@pytest.mark.parametrize(
    ("x11", "wayland", "expected"),
    [("", "", False), (":0", "", True), ("", "wayland-0", True)],
)
def test_on_linux_a_display_is_named(
    monkeypatch: pytest.MonkeyPatch, x11: str, wayland: str, expected: bool
) -> None:
    monkeypatch.setenv("DISPLAY", x11)
    monkeypatch.setenv("WAYLAND_DISPLAY", wayland)

    assert has_display() is expected


def test_elsewhere_there_is_always_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    monkeypatch.delenv("DISPLAY", raising=False)

    assert has_display()
