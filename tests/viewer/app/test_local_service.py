"""The service beside the viewer: a real process, started and ended."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from viewer.app import local_service
from viewer.app.local_service import LocalService, LocalServiceError


def lives(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except OSError:
        return False
    return True


def test_the_service_listens_and_is_gone_after_closing(tmp_path: Path) -> None:
    with LocalService(tmp_path / "store") as service:
        assert service.url.startswith("ws://127.0.0.1:")
        assert service.is_running
        assert lives(service.pid)
        pid = service.pid
    service.close()

    assert not service.is_running
    assert not lives(pid)


def test_a_service_that_cannot_start_is_told_in_its_own_words(tmp_path: Path) -> None:
    with pytest.raises(LocalServiceError, match="nowhere") as caught:
        LocalService(tmp_path / "store", ["--case", str(tmp_path / "nowhere")])

    assert "\n" not in str(caught.value)


def test_two_services_do_not_share_a_store(tmp_path: Path) -> None:
    with LocalService(tmp_path / "store"), pytest.raises(LocalServiceError, match="exit status"):
        LocalService(tmp_path / "store")


def test_a_service_that_stays_silent_is_given_up_and_ended(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    started: list[int] = []
    real = subprocess.Popen

    def silent(command: list[str], **options: object) -> "subprocess.Popen[str]":
        process: subprocess.Popen[str] = real(  # type: ignore[call-overload]
            [sys.executable, "-c", "import time; time.sleep(60)"], **options
        )
        started.append(process.pid)
        return process

    monkeypatch.setattr(local_service.subprocess, "Popen", silent)
    monkeypatch.setattr(local_service, "STOP_TIMEOUT_S", 0.5)
    with pytest.raises(LocalServiceError, match="did not listen"):
        LocalService(tmp_path / "store", ready_timeout_s=0.2)

    assert started
    assert not lives(started[0])


@pytest.mark.skipif(sys.platform == "win32", reason="file modes are POSIX")
def test_the_token_can_be_read_by_this_user_only(tmp_path: Path) -> None:
    with LocalService(tmp_path / "store") as service:
        token_file = Path(service._folder.name) / "token"
        assert token_file.read_text(encoding="utf-8").strip() == service.token
        assert token_file.stat().st_mode & 0o777 == 0o600

    assert not token_file.exists()


def test_the_service_ends_when_the_viewer_is_killed(tmp_path: Path) -> None:
    code = (
        "import sys, os\nfrom pathlib import Path\nfrom viewer.app.local_service import LocalService\n"
        "service = LocalService(Path(sys.argv[1]))\nprint(service.pid, flush=True)\nos.kill(os.getpid(), 9)\n"
    )
    root = Path(__file__).resolve().parents[3]
    viewer = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "store")],
        capture_output=True,
        text=True,
        cwd=root,
        timeout=200,
    )
    pid = int(viewer.stdout)
    ends = time.monotonic() + 60.0
    while lives(pid) and time.monotonic() < ends:
        time.sleep(0.05)

    assert not lives(pid)
