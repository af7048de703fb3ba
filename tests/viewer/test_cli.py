import sys
from pathlib import Path

import pytest

from viewer import cli


@pytest.fixture
def flown(monkeypatch: pytest.MonkeyPatch) -> list[tuple[object, Path, Path | None]]:
    calls: list[tuple[object, Path, Path | None]] = []
    monkeypatch.setattr(
        "viewer.app.program.fly_headless", lambda job, folder, script: calls.append((job, folder, script))
    )
    return calls


def call(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr(sys, "argv", ["fev-viewer", *arguments])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    code = ended.value.code
    return code if isinstance(code, int) else 0


def test_demo_without_a_display_flies_headless(
    monkeypatch: pytest.MonkeyPatch, flown: list[tuple[object, Path, Path | None]]
) -> None:
    monkeypatch.setattr(cli, "has_display", lambda: False)

    assert call(monkeypatch, "demo") == 0
    (job, folder, script) = flown[0]
    assert job.start.case == "jacksboro"  # type: ignore[attr-defined]
    assert folder == Path("out") / "demo-jacksboro"
    assert script is None


def test_a_local_flight_leaves_no_store_behind(
    monkeypatch: pytest.MonkeyPatch, flown: list[tuple[object, Path, Path | None]], tmp_path: Path
) -> None:
    assert call(monkeypatch, "--local", "malpasset", "--headless", str(tmp_path), "--duration", "600") == 0
    (job, _, _) = flown[0]

    assert job.start.duration == 600.0  # type: ignore[attr-defined]
    assert job.endpoint.data_dir is not None  # type: ignore[attr-defined]
    assert not job.endpoint.data_dir.exists()  # type: ignore[attr-defined]


def test_an_address_needs_no_local_service(
    monkeypatch: pytest.MonkeyPatch, flown: list[tuple[object, Path, Path | None]], tmp_path: Path
) -> None:
    token = tmp_path / "token"
    token.write_text("secret\n", encoding="utf-8")
    url = "ws://127.0.0.1:8765"

    assert call(monkeypatch, url, "--token-file", str(token), "--headless", str(tmp_path / "o")) == 0
    (job, _, _) = flown[0]
    assert job.endpoint.url == url  # type: ignore[attr-defined]
    assert job.endpoint.token == "secret"  # type: ignore[attr-defined]
    assert job.start is None  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["ws://a:1", "--local", "jacksboro"], "either the address"),
        (["ftp://a:1"], "must begin with ws://"),
        (["--local", "jacksboro", "--headless", __file__], "a folder is needed"),
    ],
)
def test_a_wrong_call_ends_with_one_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], arguments: list[str], complaint: str
) -> None:
    assert call(monkeypatch, *arguments) == cli.EXIT_REFUSED
    error = capsys.readouterr().err

    assert complaint in error
    assert error.count("\n") == 1


def test_an_empty_token_file_is_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / "token").write_text("\n", encoding="utf-8")

    assert call(monkeypatch, "ws://a:1", "--token-file", str(tmp_path / "token")) == cli.EXIT_REFUSED
    assert "is empty" in capsys.readouterr().err
