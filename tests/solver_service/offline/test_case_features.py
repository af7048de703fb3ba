import json
from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import RunError
from solver_service.offline.case_features import case_features, write_geojson
from solver_service.scenario import Case
from tests.solver_service.dry_case import loaded
from tests.solver_service.tiny_case import COLS, DX, ROWS, X0, Y0

BUILT = """
[[boundary]]
id = "sea"
edge = "west"
kind = "stage"
level = 306.5
from = 2040.0
to = 2100.0

[[boundary]]
edge = "north"
kind = "normal_depth"
slope = 0.002

[[source]]
at = [1105.0, 2105.0]
radius = 12.0
discharge = 20.0

[[weir]]
line = [[1200.0, 2000.0], [1200.0, 2100.0]]
crest = [305.0, 306.0]

[[culvert]]
inlet = [1055.0, 2125.0]
outlet = [1155.0, 2125.0]
diameter = 1.0

[[pump]]
inlet = [1055.0, 2105.0]
discharge = 2.0

[[breach]]
line = [[1105.0, 2085.0], [1105.0, 2155.0]]
start = "overtopping"
crest = 308.0
bottom_level = 301.0
duration = 600.0
width_final = 40.0

[[section]]
id = "low"
line = [[1300.0, 2000.0], [1300.0, 2050.0]]

[[gauge]]
id = "g"
at = [1300.0, 2100.0]
"""


@pytest.fixture
def case(tmp_path: Path) -> Case:
    return loaded(tmp_path / "case", BUILT)


def test_everything_on_the_grid_is_told_in_words(case: Case) -> None:
    told = {feature.id: feature.text for feature in case_features(case)}

    assert told["east-1"] == f"open in the east, cells 0 to {ROWS - 1}"
    assert told["sea"] == "stage in the west, cells 4 to 9, level 306.50 to 306.50 m"
    assert told["north-1"] == f"normal_depth in the north, cells 0 to {COLS - 1}, slope 0.002"
    assert told["source-1"] == "up to 20 m3/s; 5 cells (row 9, column 10) to (row 11, column 10)"
    assert told["weir-1"].startswith("crest 305.00 to 306.00 m; 10 faces (row 0, column 19, east)")
    assert "100.0 m long" in told["culvert-1"]
    assert told["culvert-1"].endswith("2 cells (row 12, column 5) (row 12, column 15)")
    assert told["pump-1"] == "up to 2 m3/s out of the terrain; 1 cell (row 10, column 5)"
    assert "starts when overtopped, crest 308.00 m, down to 301.00 m in 600 s" in told["breach-1"]
    assert told["low"] == "5 faces (row 0, column 29, east) to (row 4, column 29, east)"
    assert told["g"] == "cell (row 10, column 30)"


def test_the_map_holds_the_faces_and_cells_that_the_solver_takes(case: Case, tmp_path: Path) -> None:
    write_geojson(tmp_path / "built.geojson", case)

    collection = json.loads((tmp_path / "built.geojson").read_text())
    features = {feature["properties"]["id"]: feature for feature in collection["features"]}
    assert len(features) == 10
    weir = np.array(features["weir-1"]["geometry"]["coordinates"])
    assert weir.shape == (10, 2, 2)
    assert (weir[:, :, 0] == 1200.0).all()
    assert (weir[:, :, 1].min(), weir[:, :, 1].max()) == (2000.0, 2100.0)
    square = np.array(features["pump-1"]["geometry"]["coordinates"])
    assert square.shape == (1, 1, 5, 2)
    assert square[0, 0, :, 0].min() == X0 + 5 * DX
    assert square[0, 0, :, 1].max() == Y0 + 11 * DX
    assert features["sea"]["geometry"]["coordinates"] == [[1000.0, 2040.0], [1000.0, 2100.0]]
    assert "crs" not in collection


def test_a_file_that_cannot_be_written_is_told(case: Case, tmp_path: Path) -> None:
    with pytest.raises(RunError, match="cannot be written"):
        write_geojson(tmp_path / "none" / "built.geojson", case)
