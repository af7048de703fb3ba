"""The tour on the tiny service; `tests/end_to_end` flies it against a real one."""

import time
from pathlib import Path

import pytest

from tests.viewer import tiny_service
from tests.viewer.tiny_service import TOKEN, TinyService
from viewer.app.headless import HeadlessError, HeadlessSession
from viewer.app.tour import TourSettings, fly_tour
from viewer.app.viewer_app import ViewerApp
from viewer.commands import StartRun
from viewer.net import ConnectionThread, FrameLoader

FLOOD = tiny_service.flood
QUICK = TourSettings(start_timeout_s=20.0, watch_s=0.5, watch_least_frames=38, after_s=20.0)


def fly(service: TinyService, folder: Path) -> dict[str, object]:
    connection = ConnectionThread(service.url, TOKEN)
    app = ViewerApp(connection, FrameLoader(), StartRun("tiny"))
    connection.start()
    session = HeadlessSession(app, folder, (320, 180))
    try:
        return vars(fly_tour(session, time.monotonic(), QUICK))
    finally:
        session.close()
        app.close()
        service.close()


def test_the_tour_ends_with_pictures_and_figures(tmp_path: Path) -> None:
    summary = fly(TinyService(), tmp_path)
    pictures = summary["pictures"]

    assert isinstance(pictures, list)
    assert len(pictures) >= 9
    assert any("difference" in name for name in pictures)
    assert all((tmp_path / name).is_file() for name in pictures)
    assert (tmp_path / "contact_sheet.png").is_file()
    assert isinstance(summary["changed_share"], float)
    assert summary["changed_share"] > 0.01


def test_a_flood_that_a_levee_does_not_change_fails_the_tour(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:

    monkeypatch.setattr(tiny_service, "flood", lambda index, edits=(), branch=0: FLOOD(index))
    monkeypatch.setattr("viewer.app.tour.CHANGED_LEAST", 0.5)

    with pytest.raises(HeadlessError, match="looks like the old one"):
        fly(TinyService(), tmp_path)


def test_water_that_stands_still_has_no_front_to_stop(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:

    monkeypatch.setattr(tiny_service, "flood", lambda index, edits=(), branch=0: FLOOD(3))

    with pytest.raises(HeadlessError, match="reached no new ground"):
        fly(TinyService(), tmp_path)
