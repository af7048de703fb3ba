from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import CaseError
from solver_service.scenario import load_case
from tests.solver_service.dry_case import DRY, loaded
from tests.solver_service.tiny_case import DX, X0, Y0, write_case


def test_a_source_covers_the_cells_of_its_disc(tmp_path: Path) -> None:
    source = loaded(
        tmp_path, "\n[[source]]\nat = [1105.0, 2105.0]\nradius = 15.0\ndischarge = 20.0\n"
    ).model.sources[0]

    x, y = X0 + (source.cols + 0.5) * DX, Y0 + (source.rows + 0.5) * DX
    assert source.rows.size == 9
    assert np.hypot(x - 1105.0, y - 2105.0).max() <= 15.0
    assert source.discharge.tolist() == [20.0]


def test_a_source_follows_its_series(tmp_path: Path) -> None:
    write_case(tmp_path, DRY + '\n[[source]]\nat = [1105.0, 2105.0]\nseries = "q.csv"\n')
    (tmp_path / "q.csv").write_text("time_s,discharge\n0,0\n60,12\n")

    source = load_case(tmp_path).model.sources[0]

    assert (source.rows.tolist(), source.cols.tolist()) == ([10], [10])
    assert source.times.tolist() == [0.0, 60.0]
    assert source.discharge.tolist() == [0.0, 12.0]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("at = [1105.0, 2105.0]", "either 'discharge' in m3/s or 'series'"),
        ("at = [1105.0, 2105.0]\ndischarge = -1.0", "discharge is -1.0; a discharge in m3/s from 0 to"),
        (
            "at = [5.0, 5.0]\ndischarge = 1.0",
            r"at is \[5.0, 5.0\]; \(5, 5\) lies off the terrain; x 1000 to 1400 and y 2000 to 2240",
        ),
        ("at = [1105.0, 2105.0]\ndischarge = 1.0\nradius = -2.0", "radius is -2.0"),
        ('at = [1105.0, 2105.0]\nseries = "../q.csv"', "series is '../q.csv'; a relative path"),
    ],
)
def test_a_bad_source_is_told(tmp_path: Path, keys: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        loaded(tmp_path, f"\n[[source]]\n{keys}\n")


def test_sources_have_ids_of_their_own_or_by_number(tmp_path: Path) -> None:
    more = "\n[[source]]\nat = [1105.0, 2105.0]\ndischarge = 20.0\n"

    sources = loaded(tmp_path, more + more + 'id = "spring"\n').model.sources

    assert [source.id for source in sources] == ["source-1", "spring"]
