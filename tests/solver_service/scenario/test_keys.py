import re
from pathlib import Path

import pytest

from solver_service.scenario.keys import ARRAYS, BOUNDARY_KINDS, KEYS

REFERENCE = Path(__file__).parents[3] / "docs" / "reference" / "case_file.md"


def documented() -> dict[str, set[str]]:
    """Keys by table as the reference lists them: a heading per table, a table row per key."""
    found: dict[str, set[str]] = {}
    table: str | None = None
    for line in REFERENCE.read_text(encoding="utf-8").splitlines():
        if heading := re.match(r"#+ (?:Top of the file|`(\[+)([a-z.]+)\]+`)", line):
            table = heading[2] or ""
            assert (heading[1] == "[[") == (table in ARRAYS), line
            found[table] = set()
        elif line.startswith("#"):
            table = None
        elif table is not None and (row := re.match(r"\| `([a-z0-9_]+)` \|", line)):
            found[table].add(row[1])
    return found


@pytest.mark.parametrize("table", sorted(KEYS))
def test_every_key_is_documented_and_every_documented_key_exists(table: str) -> None:
    assert documented()[table] == set(KEYS[table])


def test_no_table_is_documented_that_does_not_exist() -> None:
    assert set(documented()) == set(KEYS)


@pytest.mark.parametrize("word", BOUNDARY_KINDS)
def test_every_kind_of_edge_is_documented(word: str) -> None:
    assert f"`{word}`" in REFERENCE.read_text(encoding="utf-8")


def test_arrays_and_tables_below_others_are_keys_of_those() -> None:
    for name in KEYS:
        above, _, below = name.rpartition(".")
        if above:
            assert below in KEYS[above]
            assert name in ARRAYS
