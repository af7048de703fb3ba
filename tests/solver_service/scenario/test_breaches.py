from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import ServiceError
from tests.solver_service.dry_case import loaded
from tests.solver_service.tiny_case import valley

BREACH = """
[[breach]]
line = [[1105.0, 2085.0], [1105.0, 2155.0]]
duration = 600.0
bottom_level = 302.0
"""
LINEAR = BREACH + "width_final = 40.0\n"


def dam() -> np.ndarray:
    """The valley with a levee on column 10 with its crest at 310 m, 310.5 m in the middle."""
    bed = valley()
    bed[:, 10] = 310.0
    bed[12, 10] = 310.5
    return bed


def test_a_breach_begins_at_the_crest_of_its_line(tmp_path: Path) -> None:
    case = loaded(tmp_path, LINEAR + "start_time = 5.0\nside_slope = 1.0\n", dam())

    (breach,) = case.model.breaches
    assert (breach.id, breach.law, breach.start, breach.start_time) == ("breach-1", "linear", "time", 5.0)
    assert breach.crest == pytest.approx(310.5 - case.grid.datum_offset)
    assert breach.bottom_level == pytest.approx(302.0 - case.grid.datum_offset)
    assert (breach.width_initial, breach.width_final, breach.side_slope) == (0.0, 40.0, 1.0)
    assert set(breach.snapped(case.grid.shape, case.grid.dx).cells[:, 1].tolist()) == {10}
    assert case.warnings == ()


def test_the_growing_law_has_its_numbers(tmp_path: Path) -> None:
    law = 'law = "verheij_van_der_knaap"\nstart = "overtopping"\ncritical_velocity = 0.5\ncrest = 309.0\n'

    (breach,) = loaded(tmp_path, BREACH + law, dam()).model.breaches

    assert (breach.law, breach.start, breach.width_initial) == ("verheij_van_der_knaap", "overtopping", 10.0)
    assert (breach.f1, breach.f2, breach.critical_velocity) == (1.3, 0.04, 0.5)
    assert breach.width_final is None


def test_a_breach_after_the_end_is_told(tmp_path: Path) -> None:
    (warning,) = loaded(tmp_path, LINEAR + "start_time = 900.0\n", dam()).warnings

    assert "[[breach]] number 1 starts at 900 s, after the end of the run at 20 s" in warning


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (BREACH, "width_final is missing; a width in m is needed where law = 'linear'"),
        (LINEAR + "f1 = 1.0", "f1 is 1.0; it is allowed where law = 'verheij_van_der_knaap'"),
        (
            LINEAR.replace("302.0", "311.0"),
            "highest ground of its line, is at 310.50 m; a",
        ),
        (LINEAR + "crest = 301.0", "bottom_level is 302.0; the crest is at 301.00 m; a level below it"),
        (LINEAR + "crest = 3010.0", "crest is 3010.0; the highest ground of its line is at 310.50 m"),
        (
            LINEAR.replace("40.0", "71.0"),
            r"width_final is 71.0; a width in m above 0, up to .*70 m",
        ),
        (LINEAR + "width_initial = 50.0", "width_initial is 50.0; a width in m from 0 to"),
        (LINEAR.replace("duration = 600.0", ""), "duration is missing; a time in s above 0"),
        (LINEAR.replace("duration = 600.0", "duration = 0.0"), "duration is 0.0"),
        (LINEAR + 'start = "rain"', "start is 'rain'; 'time', 'overtopping' is allowed"),
        (LINEAR + 'law = "froehlich"', "law is 'froehlich'; 'linear', 'verheij_van_der_knaap' is allowed"),
        (LINEAR.replace("1105.0", "1005.0"), "breach-1"),
        (
            LINEAR.replace("2085.0], [1105.0, 2155.0", "2085.0], [1106.0, 2086.0"),
            r"a line of at least one cell \(10 m\)",
        ),
        (LINEAR.replace("1105.0", "9.0"), "lies off the terrain"),
        (LINEAR + LINEAR, r"number 2 line is .*; it may eat cell \(row 10, column 10\), as number 1 may"),
        (
            LINEAR + 'id = "a"\n' + LINEAR.replace("1105.0", "1205.0") + 'id = "a"\ncrest = 304.0',
            "'a' is the id of a breach, and of a breach",
        ),
    ],
)
def test_a_bad_breach_is_told(tmp_path: Path, table: str, message: str) -> None:
    with pytest.raises(ServiceError, match=message) as caught:
        loaded(tmp_path, f"\n{table}\n", dam())

    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("case.toml: ")


def test_more_cells_than_a_frame_can_tell_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    count = len(loaded(tmp_path, LINEAR, dam()).model.breaches[0].snapped((30, 40), 10.0).cells)
    monkeypatch.setattr("solver_service.scenario.breaches.MAX_BED_CELLS", count - 1)
    with pytest.raises(ServiceError, match=f"{count} cells may be eaten; up to {count - 1} in all"):
        loaded(tmp_path, LINEAR, dam())
