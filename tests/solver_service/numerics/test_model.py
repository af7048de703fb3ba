"""What a flood model refuses."""

import numpy as np
import pytest

from solver_service.numerics import FloodModel, ModelError, Rain, Source

BED = np.zeros((10, 12), np.float32)


def with_value(value, row=3, col=4):
    raster = BED.copy()
    raster[row, col] = value
    return raster


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"z_b": with_value(np.nan)}, r"bed is nan in cell \(row 3, column 4\)"),
        ({"z_b": np.zeros((1, 5))}, "at least 2 cells"),
        ({"dx": 0.0}, "cell size"),
        ({"dx": float("nan")}, "cell size"),
        ({"manning_n": with_value(-0.1)}, "roughness is -0.1"),
        ({"manning_n": float("nan")}, "roughness is nan"),
        ({"manning_n": np.zeros((3, 3))}, "roughness has the shape"),
        ({"blocked": np.zeros((3, 3), bool)}, "blocked mask has the shape"),
        ({"rain": Rain.uniform(0.0, 1e-5, (10, 11))}, r"rain covers \(10, 11\) rows and columns"),
        ({"sources": (Source([3], [4], [0.0], [1.0]),), "blocked": with_value(1.0).astype(bool)}, "no data"),
    ],
)
def test_what_is_not_valid_is_refused_in_one_sentence(arguments, words):
    with pytest.raises(ModelError, match=words) as caught:
        FloodModel(**{"dx": 5.0, "z_b": BED, "manning_n": 0.03, **arguments})
    assert "\n" not in str(caught.value)
