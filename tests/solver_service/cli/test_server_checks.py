import os
import socket
from pathlib import Path

import pytest

from solver_service.cli.server_checks import Check, check_server
from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore

NAMES = [
    "settings",
    "data folder",
    "room",
    "kernel cache",
    "device",
    "port",
    "tls",
    "token file",
    "token store",
]


def checked(tmp_path: Path, **settings: object) -> dict[str, Check]:
    """What the doctor finds for a server with these settings."""
    settings.setdefault("data_dir", str(tmp_path / "data"))
    config = tmp_path / "server.toml"
    lines = (f"{name} = {value!r}\n" for name, value in settings.items())
    config.write_text("".join(lines), encoding="utf-8")
    found = check_server(config, {})
    assert [check.name for check in found] == NAMES
    return {check.name: check for check in found}


def only_bad(found: dict[str, Check], name: str, words: str) -> None:
    assert [check.name for check in found.values() if not check.is_good] == [name]
    assert words in found[name].words


def test_a_machine_that_lacks_nothing_is_good_and_nothing_is_made(tmp_path: Path) -> None:
    found = checked(tmp_path)
    assert all(check.is_good for check in found.values()), found
    assert not (tmp_path / "data").exists()
    assert "server.toml" in found["settings"].words


def test_a_wrong_setting_is_told_and_the_rest_is_still_looked_at(tmp_path: Path) -> None:
    found = check_server(None, {"FEV_SERVE_PORT": "x"})
    assert [check.name for check in found] == NAMES
    assert not found[0].is_good
    assert "FEV_SERVE_PORT" in found[0].words


def test_a_data_folder_that_is_a_file_is_bad(tmp_path: Path) -> None:
    (tmp_path / "data").write_text("")
    found = checked(tmp_path)
    assert not found["data folder"].is_good
    assert "is no folder" in found["data folder"].words


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_data_folder_that_cannot_be_written_is_bad(tmp_path: Path) -> None:
    (tmp_path / "data").mkdir(mode=0o500)
    assert not checked(tmp_path)["data folder"].is_good


def test_a_disk_without_room_is_bad(tmp_path: Path) -> None:
    only_bad(checked(tmp_path, reserve_bytes=1 << 60), "room", "runs would pause at once")


def test_a_device_that_is_not_there_is_bad(tmp_path: Path) -> None:
    only_bad(checked(tmp_path, device="cuda:99"), "device", "cuda:99")


def test_a_port_that_is_taken_is_bad(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        only_bad(checked(tmp_path, port=port), "port", f"port {port} cannot be listened on")


def test_a_certificate_without_its_key_is_bad(tmp_path: Path) -> None:
    only_bad(checked(tmp_path, tls_certificate=str(tmp_path / "no.pem")), "tls", "tls_key is not set")


@pytest.mark.skipif(os.name != "posix", reason="files have rights on POSIX")
def test_a_token_file_that_others_can_read_is_bad_and_one_for_its_owner_is_good(tmp_path: Path) -> None:
    token = tmp_path / "token"
    token.write_text("x" * 40)
    token.chmod(0o644)
    only_bad(checked(tmp_path, token_file=str(token)), "token file", "can be read by others")
    token.chmod(0o600)
    found = checked(tmp_path, token_file=str(token))
    assert found["token file"].is_good
    assert "x" * 40 not in str(found)
    token.write_text("short")
    only_bad(checked(tmp_path, token_file=str(token)), "token file", "holds no token")


def test_the_tokens_are_counted_and_a_torn_store_is_bad(tmp_path: Path) -> None:
    store = TokenStore(tmp_path / "data")
    store.create("a", Scope.VIEWER, None)
    store.close()
    assert checked(tmp_path)["token store"].words == "1 tokens that are not revoked"
    for path in (tmp_path / "data").glob("tokens.sqlite*"):
        path.write_bytes(b"not a database at all, but long enough to be looked at" * 10)
    only_bad(checked(tmp_path), "token store", "cannot be read")
