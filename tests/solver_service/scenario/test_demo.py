from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, write_case


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (
            "line = [[1100.0, 2100.0], [1200.0, 2100.0]]\nwidth = 0.0\nmagnitude = 2.0",
            "width is 0.0; a width in m above 0",
        ),
        ("line = [[1100.0, 2100.0], [5.0, 5.0]]\nwidth = 20.0\nmagnitude = 2.0", "outside the terrain"),
        (
            'line = [[1100.0, 2100.0], [1200.0, 2100.0]]\nwidth = 20.0\nmagnitude = 2.0\ntype = "replace"',
            "needs 'level'",
        ),
        (
            'line = [[1100.0, 2100.0], [1200.0, 2100.0]]\nwidth = 20.0\nmagnitude = 2.0\noperation = "dig"',
            "'raise', 'lower'",
        ),
    ],
)
def test_a_bad_edit_of_the_tour_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        load_case(write_case(tmp_path, f"{CASE}\n[demo]\n[[demo.edit]]\n{keys}\n"))
