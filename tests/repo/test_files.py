"""What holds for every tracked file: short modules, one encoding, no traces of one machine."""

import re
from pathlib import Path

from tests.repo.tracked import REPOSITORY, tracked_names

MAX_LINES = 400
MAX_BYTES = 2_000_000
TEXT = {".py", ".md", ".toml", ".yaml", ".yml", ".glsl", ".vert", ".frag", ".lock", ".Dockerfile", ""}


def tracked_files() -> list[Path]:
    """Files that git knows; without git (a source archive) all files outside hidden and built folders."""
    names = tracked_names()
    if names is not None:
        return [REPOSITORY / name for name in names]
    built = re.compile(r"\.(?!ci$).+|build|dist|out|site|__pycache__|.+\.egg-info")
    every = (path for path in REPOSITORY.rglob("*") if path.is_file())
    return [path for path in every if not any(map(built.fullmatch, path.relative_to(REPOSITORY).parts[:-1]))]


FILES = tracked_files()
TEXT_FILES = [path for path in FILES if path.suffix in TEXT]
PYTHON_FILES = [path for path in FILES if path.suffix == ".py" or path.name == "fev"]


def relative(path: Path) -> str:
    return path.relative_to(REPOSITORY).as_posix()


def test_there_are_files_to_look_at() -> None:
    assert len(PYTHON_FILES) > 50


def test_a_python_file_is_short_enough_to_be_read_at_once() -> None:
    lengths = {relative(path): len(path.read_text(encoding="utf-8").splitlines()) for path in PYTHON_FILES}

    assert not {name: length for name, length in lengths.items() if length > MAX_LINES}


def test_code_is_ascii_with_unix_line_ends() -> None:
    for path in PYTHON_FILES:
        text = path.read_bytes()
        # Tests may name people and places as they are spelt.
        assert text.isascii() or relative(path).startswith("tests/"), relative(path)
        assert b"\r" not in text, relative(path)
        assert not text or text.endswith(b"\n"), relative(path)


def test_no_file_names_a_folder_of_one_machine_or_a_registry() -> None:
    # The folder names are put together here, or this file would find itself.
    folders = ("/" + "work/", "/" + "root/", "/home/" + r"(?!fev\b)\w+/", "/" + "Users/", "file:///" + "opt")
    hosts = ("pypi" + r"\.org", "pythonhosted" + r"\.org", "deb\\.debian" + r"\.org", "npmjs" + r"\.org")
    pattern = re.compile("|".join(folders + hosts))
    found = [
        f"{relative(path)}:{number}: {line.strip()}"
        for path in TEXT_FILES
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if pattern.search(line)
    ]

    assert not found, "\n".join(found)


def test_no_unfinished_business_is_marked_in_the_code() -> None:
    pattern = re.compile(r"\b(" + "TO" + r"DO|FIX" + r"ME|XX" + r"X)\b|NotImplemented" + "Error")
    found = [
        f"{relative(path)}:{number}: {line.strip()}"
        for path in PYTHON_FILES
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if pattern.search(line)
    ]

    assert not found, "\n".join(found)


def test_no_module_is_called_a_drawer_for_odds_and_ends() -> None:
    banned = {"utils", "util", "helpers", "helper", "common", "misc", "manager", "core", "base_utils"}

    assert not [relative(path) for path in PYTHON_FILES if path.stem in banned or path.parent.name in banned]


def test_no_large_file_is_tracked() -> None:
    assert not [relative(path) for path in FILES if path.stat().st_size > MAX_BYTES]
