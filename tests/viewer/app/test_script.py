import json
from pathlib import Path

import pytest

from viewer.app.script import ScriptError, ScriptStep, read_script
from viewer.commands import Pause, Seek


def test_toml_and_json_say_the_same(tmp_path: Path) -> None:
    toml = tmp_path / "a.toml"
    toml.write_text(
        '[[step]]\nuntil_time = 600\ncommand = "Pause"\n'
        '[[step]]\ncommand = "Seek"\ntime = 60\npicture = "a.png"\n'
    )
    other = tmp_path / "a.json"
    other.write_text(
        json.dumps(
            [{"until_time": 600, "command": "Pause"}, {"command": "Seek", "time": 60, "picture": "a.png"}]
        )
    )
    expected = [ScriptStep(until_time=600, command=Pause()), ScriptStep(command=Seek(60.0), picture="a.png")]

    assert read_script(toml) == expected
    assert read_script(other) == expected


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("{", "a.json"),
        ("{}", "a list of steps"),
        ("[1]", "a list of steps"),
        ('[{"command": "Fly"}]', "step 1: command 'Fly' is unknown"),
        ('[{"at_wall": -1}]', "at_wall = -1"),
        ('[{"until_time": "soon"}]', "until_time = 'soon'"),
        ('[{"picture": "../a.png"}]', "plain file name"),
        ('[{"picture": 7}]', "plain file name"),
    ],
)
def test_a_wrong_script_is_refused_with_file_and_step(tmp_path: Path, text: str, complaint: str) -> None:
    path = tmp_path / "a.json"
    path.write_text(text)

    with pytest.raises(ScriptError) as caught:
        read_script(path)
    assert complaint in str(caught.value)
    assert "a.json" in str(caught.value)


def test_a_script_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(ScriptError, match=r"missing\.toml"):
        read_script(tmp_path / "missing.toml")
