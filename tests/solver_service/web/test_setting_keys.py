import dataclasses
from pathlib import Path

import pytest

from solver_service.web import ServiceSettings
from solver_service.web.setting_keys import KEYS

BY_NAME = {key.name: key for key in KEYS}


def test_every_field_of_the_settings_is_a_key_and_every_key_a_field() -> None:
    assert [key.name for key in KEYS] == [field.name for field in dataclasses.fields(ServiceSettings)]


def test_every_default_but_none_is_allowed() -> None:
    for key in KEYS:
        if key.default is not None:
            assert key.read(key.default, Path()) == key.default, key.name


@pytest.mark.parametrize(
    ("name", "given", "meant"),
    [
        ("port", 8765, 8765),
        ("port", 65536, None),
        ("port", -1, None),
        ("port", True, None),
        ("port", "8765", None),
        ("port", 8765.0, None),
        ("checkpoint_interval_s", 30, 30.0),
        ("checkpoint_interval_s", float("nan"), None),
        ("checkpoint_interval_s", 0.0, None),
        ("stop_with_stdin", 1, None),
        ("stop_with_stdin", True, True),
        ("device", "cuda:1", "cuda:1"),
        ("device", "cuda:1 ", None),
        ("host", "", None),
        ("cases", ["a", "b"], ("a", "b")),
        ("cases", ["a", ""], None),
        ("cases", "a", None),
        ("channels", ["maxima"], ("maxima",)),
        ("channels", [], ()),
        ("channels", ["maxima", "tides"], None),
        ("data_dir", "runs", Path("/srv/runs")),
        ("data_dir", "/other", Path("/other")),
        ("data_dir", "", None),
    ],
)
def test_a_value_of_the_file_is_read_or_refused(name: str, given: object, meant: object) -> None:
    assert BY_NAME[name].read(given, Path("/srv")) == meant


@pytest.mark.parametrize(
    ("name", "text", "meant"),
    [
        ("port", "8765", 8765),
        ("port", "8765.5", None),
        ("restart_within_s", "1e3", 1000.0),
        ("restart_within_s", "inf", None),
        ("stop_with_stdin", "true", True),
        ("stop_with_stdin", "False", False),
        ("stop_with_stdin", "1", None),
        (
            "allowed_origins",
            "https://a.example, https://b.example",
            ("https://a.example", "https://b.example"),
        ),
        ("allowed_origins", "https://a.example,,", None),
        ("allowed_origins", "", ()),
    ],
)
def test_a_text_of_the_environment_is_read_or_refused(name: str, text: str, meant: object) -> None:
    assert BY_NAME[name].read_text(text, Path()) == meant


def test_what_is_allowed_is_told_with_its_limits() -> None:
    assert BY_NAME["port"].allowed_words == "a whole number from 0 to 65535"
    assert BY_NAME["store_bytes"].allowed_words == "a whole number of 1 or more"
