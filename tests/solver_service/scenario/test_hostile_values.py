"""Every key of a full case file with every kind of wrong value: a case or one sentence, no more."""

import copy
import json
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from solver_service.errors import ServiceError
from solver_service.scenario import load_case
from solver_service.scenario.keys import ARRAYS, KEYS
from tests.solver_service.tiny_case import CASE, COLS, GAUGES, ROWS, write_case

MORE = """
[demo]
time = 3.0
target = [1200.0, 2100.0]

[[demo.edit]]
line = [[1150.0, 2050.0], [1150.0, 2150.0]]
width = 20.0
operation = "raise"
type = "replace"
magnitude = 3.0
level = 309.0

[[source]]
at = [1105.0, 2105.0]
radius = 15.0
discharge = 2.0

[rain]
rate = 5.0

[infiltration]
model = "horton"
rate_initial = 50.0
rate_final = 5.0
decay = 2.0

[[infiltration.zone]]
polygon = [[1000, 2000], [1100, 2000], [1100, 2240]]
rate_initial = 0.0
rate_final = 0.0
decay = 0.0

[[weir]]
line = [[1200.0, 2010.0], [1200.0, 2230.0]]
crest = 305.0

[[culvert]]
inlet = [1155.0, 2125.0]
outlet = [1255.0, 2125.0]
inlet_level = 303.0
outlet_level = 302.0
diameter = 1.0

[[pump]]
inlet = [1055.0, 2125.0]
discharge = 1.0
start_level = 304.0
stop_level = 303.0

[[breach]]
line = [[1105.0, 2085.0], [1105.0, 2155.0]]
law = "verheij_van_der_knaap"
start_time = 1.0
duration = 5.0
crest = 305.0
bottom_level = 301.0
width_initial = 1.0
width_final = 40.0

[[roughness.zone]]
polygon = [[1000, 2000], [1100, 2000], [1100, 2240]]
manning_n = 0.1

[[terrain.raise]]
polygon = [[1200, 2000], [1300, 2000], [1300, 2240]]
by = 1.0
"""
FULL: dict[str, Any] = tomllib.loads(CASE + GAUGES + MORE)
WRONG: list[Any] = [
    math.nan,
    math.inf,
    -math.inf,
    -1.0,
    0,
    1e308,
    2**63 - 1,
    True,
    "",
    "x" * 10_000,
    "../../etc/passwd",
    "\u202e\u0000",
    [],
    [[]],
    [math.nan, math.nan],
    [[0.0, 0.0], [1e308, -1e308], [5.0, math.inf]],
    {},
    {"level": {"level": {}}},
    [{}, {}],
]
PLACES = [(table, key) for table in sorted(KEYS) for key in sorted(KEYS[table])]


def toml(value: Any) -> str:
    """A value in place; tables and arrays of tables too."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value) if isinstance(value, str) else repr(value)


def with_value(table: str, key: str, value: Any) -> str:
    """The full case with one key set, in the first table of its name."""
    case = copy.deepcopy(FULL)
    node = case
    path = ""
    for part in table.split(".") if table else []:
        path = f"{path}.{part}" if path else part
        if path in ARRAYS:
            node = node.setdefault(part, [{}])[0]
        else:
            node = node.setdefault(part, {})
    node[key] = value
    return "\n".join(f"{name} = {toml(item)}" for name, item in case.items())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = write_case(tmp_path_factory.mktemp("hostile"))
    np.savez(folder / "depth.npz", depth=np.zeros((ROWS, COLS)))
    return folder


def test_the_full_case_is_sound(folder: Path) -> None:
    (folder / "case.toml").write_text(with_value("case", "title", "all keys"))

    assert load_case(folder).title == "all keys"


@pytest.mark.parametrize(("table", "key"), PLACES, ids=[f"{table}.{key}" for table, key in PLACES])
def test_a_wrong_value_is_a_case_or_one_sentence(folder: Path, table: str, key: str) -> None:
    refused = 0
    for value in WRONG:
        (folder / "case.toml").write_text(with_value(table, key, value))
        try:
            load_case(folder)
        except ServiceError as error:
            refused += 1
            message = str(error)
            assert "\n" not in message
            assert message.startswith("case.toml")
            assert len(message) < 1000

    assert refused >= len(WRONG) // 2


@pytest.mark.parametrize(("table", "key"), [place for place in PLACES if place[1] in ("line", "polygon")])
def test_a_line_of_far_too_many_points_is_refused(folder: Path, table: str, key: str) -> None:
    (folder / "case.toml").write_text(with_value(table, key, [[1100.0, 2100.0]] * 5000))

    with pytest.raises(ServiceError, match=rf"{key} is .*; \d to 4096 points "):
        load_case(folder)
