from pathlib import Path

import numpy as np
import pytest

from solver_service.errors import TerrainError
from solver_service.terrain.read_dem import FORMATS, format_of, read_dem
from tests.solver_service.selafin_file import write_selafin


@pytest.mark.parametrize(
    ("name", "suffix"),
    [
        ("a.TIF", ".tif"),
        ("N49E011.hgt.zip", ".hgt.zip"),
        ("m.slf.gz", ".slf.gz"),
        ("m.slf", ".slf"),
        ("a.zip", None),
    ],
)
def test_the_longest_suffix_says_the_format(name: str, suffix: str | None) -> None:
    assert format_of(Path(name)) == suffix


def test_an_unknown_format_lists_the_known_ones(tmp_path: Path) -> None:
    (tmp_path / "bed.vrt").write_text("<VRTDataset/>")

    with pytest.raises(TerrainError, match=r"'bed.vrt' is of no known terrain format; \.tif, "):
        read_dem(tmp_path / "bed.vrt")


@pytest.mark.parametrize("suffix", sorted(FORMATS))
def test_a_missing_file_is_named(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(TerrainError, match=f"'N49E011{suffix}' does not exist"):
        read_dem(tmp_path / f"N49E011{suffix}", key="bed")


@pytest.mark.parametrize("suffix", sorted(FORMATS))
def test_a_file_of_another_kind_under_a_known_name_is_refused(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"N49E011{suffix}"
    path.write_bytes(b"#!/bin/sh\necho this is no terrain\n" * 40)

    with pytest.raises(TerrainError):
        read_dem(path, key="bed", cell_size=1.0)


def test_bounds_apply_to_rasters_and_meshes_alike(tmp_path: Path) -> None:
    np.savez(tmp_path / "bed.npz", bed=np.zeros((6, 10)), dx=10.0, x0=0.0, y0=0.0)
    mesh = write_selafin(tmp_path / "mesh.slf")
    bounds = (20.0, 10.0, 60.0, 40.0)

    assert read_dem(tmp_path / "bed.npz", key="bed", bounds=bounds).bounds == bounds
    assert read_dem(mesh, cell_size=10.0, bounds=bounds).bounds == bounds
