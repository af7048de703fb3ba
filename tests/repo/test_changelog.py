"""Every changelog fragment is one sentence of a known kind, so that the release notes write themselves."""

import re
import tomllib
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
FRAGMENTS = sorted((REPOSITORY / "docs" / "changelog.d").glob("*"))
CONFIGURATION = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["tool"][
    "towncrier"
]
KINDS = {kind["directory"] for kind in CONFIGURATION["type"]}


def test_fragments_are_named_after_the_change_and_its_kind() -> None:
    wrong = [
        path.name
        for path in FRAGMENTS
        if not re.fullmatch(rf"[a-z0-9-]+\.({'|'.join(KINDS)})\.md", path.name)
    ]

    assert not wrong


def test_a_fragment_is_one_sentence_on_one_line_with_a_full_stop() -> None:
    for path in FRAGMENTS:
        text = path.read_text(encoding="utf-8")
        assert re.fullmatch(r"[A-Z][^\n]*\.\n?", text), path.name


def test_the_changelog_has_the_line_below_which_releases_are_put() -> None:
    changelog = (REPOSITORY / CONFIGURATION["filename"]).read_text(encoding="utf-8")

    assert changelog.count(CONFIGURATION["start_string"]) == 1
