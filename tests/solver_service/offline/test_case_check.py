from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import DeviceError
from solver_service.offline import check_case
from solver_service.scenario import load_case
from tests.solver_service.tiny_case import CASE, GAUGES, valley, write_case


def test_a_sound_case_has_facts_and_no_warnings(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path, CASE + GAUGES))

    report = check_case(case, "cpu")

    facts = dict(report.facts)
    assert report.warnings == []
    assert facts["coordinates"] == "local, metres"
    assert facts["cells"] == "24 x 40 = 960 of 10 m"
    assert facts["boundary"] == "east-1: open in the east, cells 0 to 23"
    assert facts["gauge"] == "lower: cell (row 12, column 15)"
    assert report.figures["cells"] == 960
    assert report.figures["volume_initial_m3"] == pytest.approx(case.initial_h.sum() * 100.0, rel=1e-6)
    assert 0.0 < report.figures["run_time_s"] < 600.0


def test_odd_things_are_told(tmp_path: Path) -> None:
    bed = valley()
    bed[12, 30] -= 9.0
    bed[12, 15] = np.nan
    text = CASE.replace('vertical_datum = "the floor"\n', "") + GAUGES
    text += "\n[[source]]\nat = [1005.0, 2005.0]\ndischarge = 1.0\n"

    report = check_case(load_case(write_case(tmp_path, text, bed)), "cpu")

    said = "\n".join(report.warnings)
    assert "A single cell lies 8.9 m below" in said
    assert "vertical_datum does not say" in said
    assert "[[source]] number 1 touches the edge" in said
    assert "Gauge 'lower' stands on a cell without data" in said
    assert dict(report.facts)["cells without data"] == "1 (1 walls)"
    assert report.figures["pits"] >= 1


def test_a_case_without_water_is_odd(tmp_path: Path) -> None:
    dry = CASE[: CASE.index("[[initial.level]]")] + CASE[CASE.index("[[boundary]]") :]

    report = check_case(load_case(write_case(tmp_path, dry)), "cpu")

    assert any("no water" in warning for warning in report.warnings)


def test_an_absent_device_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DeviceError, match="cuda:17"):
        check_case(load_case(write_case(tmp_path)), "cuda:17")


STORM = "time_s,rain_mm_h\n-3600,50\n3600,100\n7200,0\n"


@pytest.mark.parametrize(
    ("keys", "depth"),
    # Linear: from 75 to 100 mm/h in the first hour, then down to 50 in half an hour; the run lasts 5400 s.
    [("", 87.5 + 37.5), ('interpolation = "step"\n', 50.0 + 50.0)],
)
def test_the_rain_of_the_whole_run_is_told_as_depth(tmp_path: Path, keys: str, depth: float) -> None:
    text = CASE.replace("duration = 20.0", "duration = 5400.0") + f'\n[rain]\nseries = "r.csv"\n{keys}'
    write_case(tmp_path, text)
    (tmp_path / "r.csv").write_text(STORM)

    facts = dict(check_case(load_case(tmp_path), "cpu").facts)

    assert facts["rain"] == f"up to 100 mm/h, {depth:g} mm in all, 1 x 1 rain cells"


def test_rain_that_begins_late_is_not_counted_before(tmp_path: Path) -> None:
    write_case(tmp_path, CASE + '\n[rain]\nseries = "r.csv"\n')
    (tmp_path / "r.csv").write_text("time_s,rain\n10,360\n20,360\n")

    report = check_case(load_case(tmp_path), "cpu")

    assert "1 mm in all" in dict(report.facts)["rain"]
    assert any("r.csv: begins at 10 s" in warning for warning in report.warnings)


def test_structures_that_do_nothing_are_told(tmp_path: Path) -> None:
    line = "line = [[1205.0, 2060.0], [1205.0, 2180.0]]\n"
    weirs = f'\n[[weir]]\nid = "low"\n{line}crest = 300.5\n[[weir]]\nid = "high"\n{line}crest = 307.0\n'
    growth = "crest = 310.0\nduration = 5.0\nwidth_final = 20.0\n"
    breaches = "".join(
        f'\n[[breach]]\nid = "to {level}"\n{line.replace("1205.0", x)}{growth}bottom_level = {level}\n'
        for level, x in ((309.0, "1155.0"), (301.0, "1255.0"))
    )

    report = check_case(load_case(write_case(tmp_path, CASE + weirs + breaches)), "cpu")

    assert report.warnings == [
        "The weir 'low' lies below the ground everywhere: it does nothing.",
        "The ground of the breach 'to 309.0' lies below its bottom level: it does nothing.",
    ]


def test_memory_is_told_line_by_line_and_for_a_card_of_24_gb(tmp_path: Path) -> None:
    case = load_case(write_case(tmp_path, CASE + "arrival_depths = [0.5]\n"))

    report = check_case(case, "cpu")

    facts = "\n".join(f"{label}: {value}" for label, value in report.facts)
    assert "water, two states" in facts
    assert "arrival by depth class" in facts
    assert 40 * 960 < report.figures["memory_bytes"] < 10_000_000
    assert 0.0 < report.figures["card_24_gb_share"] < 1e-3
    assert "such a case fits up to" in dict(report.facts)["a card of 24 GB"]
