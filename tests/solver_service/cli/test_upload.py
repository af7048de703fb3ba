"""`fev-solver upload` against a real service, and what it refuses by itself."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from bench.service_process import ServiceProcess
from solver_service.cli.upload import case_files
from solver_service.errors import CaseError
from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore
from tests.solver_service.tiny_case import write_case


@pytest.fixture(scope="module")
def receiver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServiceProcess]:
    options = {"spare_workers": 0, "upload_bytes": 200_000}
    with ServiceProcess(tmp_path_factory.mktemp("upload"), **options) as service:
        yield service


@pytest.fixture
def case(tmp_path: Path) -> Path:
    folder = write_case(tmp_path / "valley")
    (folder / "notes.docx").write_bytes(b"PK")
    (folder / ".hidden").write_bytes(b"secret")
    return folder


def test_a_folder_is_sent_without_what_is_no_case_and_is_then_on_offer(
    fev_solver, receiver: ServiceProcess, case: Path, tmp_path: Path
) -> None:
    words = ("--server", receiver.url, "--token-file", receiver.data_dir / "token")
    answer = fev_solver("upload", case, *words, "--json")
    assert answer.code == 0, answer.err
    assert json.loads(answer.out) == {"case": "tiny", "warnings": []}
    assert "left out: notes.docx" in answer.err
    files = receiver.data_dir / "cases" / "tiny" / "case"
    assert sorted(path.name for path in files.iterdir()) == ["bed.npz", "case.toml"]

    (case / "bed.npz").write_bytes(b"PK\3\4 broken")
    (case / "notes.docx").unlink()
    broken = fev_solver("upload", case / "case.toml", *words)
    assert broken.code == 2
    assert "bed.npz" in broken.err
    assert str(receiver.data_dir) not in broken.err


def test_what_the_service_does_not_allow_is_told(
    fev_solver, receiver: ServiceProcess, case: Path, tmp_path: Path
) -> None:
    store = TokenStore(receiver.data_dir)
    token, _ = store.create("guest", Scope.VIEWER, None)
    store.close()
    (tmp_path / "guest").write_text(token)
    (tmp_path / "wrong").write_text("no-token-of-anybody")
    for name, words in (("guest", "needs the scope controller"), ("wrong", "token that holds")):
        answer = fev_solver("upload", case, "--server", receiver.http, "--token-file", tmp_path / name)
        assert answer.code == 2
        assert words in answer.err

    large = tmp_path / "large.fevcase"
    large.write_bytes(bytes(range(256)) * 1000)
    answer = fev_solver(
        "upload", large, "--server", receiver.http, "--token-file", receiver.data_dir / "token"
    )
    assert answer.code == 2
    assert "200000 are allowed" in answer.err


@pytest.mark.parametrize("server", ["ftp://host", "ws://", "ws://host:port", "http://127.0.0.1:9"])
def test_a_server_that_is_none_is_told(fev_solver, case: Path, tmp_path: Path, server: str) -> None:
    (tmp_path / "token").write_text("some-token")
    answer = fev_solver("upload", case, "--server", server, "--token-file", tmp_path / "token")
    assert answer.code == 2
    assert "is allowed" in answer.err or "gives no answer" in answer.err


def test_a_token_file_that_is_not_there_is_told(fev_solver, case: Path, tmp_path: Path) -> None:
    answer = fev_solver("upload", case, "--server", "ws://127.0.0.1:9", "--token-file", tmp_path / "none")
    assert answer.code == 2
    assert "token file" in answer.err


def test_a_folder_without_a_case_is_told(tmp_path: Path, case: Path) -> None:
    assert [name for _, name in case_files(case)] == ["bed.npz", "case.toml"]
    shutil.rmtree(case)
    case.mkdir()
    with pytest.raises(CaseError, match=r"holds no case.toml"):
        list(case_files(case))
