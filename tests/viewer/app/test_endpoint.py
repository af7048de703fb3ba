from pathlib import Path

import pytest

from viewer.app.endpoint import read_token, stream_url
from viewer.errors import ViewerError


@pytest.mark.parametrize(
    ("url", "stream"),
    [
        ("ws://127.0.0.1:8765", "ws://127.0.0.1:8765/v1/stream"),
        ("wss://flood.example/", "wss://flood.example/v1/stream"),
        ("wss://flood.example/fev/v1/stream", "wss://flood.example/fev/v1/stream"),
    ],
)
def test_an_address_without_a_path_gets_that_of_the_stream(url: str, stream: str) -> None:
    assert stream_url(url) == stream


@pytest.mark.parametrize("url", ["", "http://flood.example", "127.0.0.1:8765", "file:///etc/passwd"])
def test_what_is_no_websocket_address_is_refused(url: str) -> None:
    with pytest.raises(ViewerError, match="must begin with ws://"):
        stream_url(url)


def test_a_token_is_read_without_its_line_feed(tmp_path: Path) -> None:
    (tmp_path / "token").write_text("secret\n", encoding="utf-8")

    assert read_token(tmp_path / "token") == "secret"
    assert read_token(None) is None


def test_a_token_file_that_is_missing_empty_or_no_text_is_told(tmp_path: Path) -> None:
    (tmp_path / "empty").write_text(" \n", encoding="utf-8")
    (tmp_path / "bytes").write_bytes(b"\xff\xfe\x00")
    for name, complaint in (("gone", "cannot be read"), ("empty", "is empty"), ("bytes", "cannot be read")):
        with pytest.raises(ViewerError, match=complaint):
            read_token(tmp_path / name)
