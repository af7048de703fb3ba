import zipfile
from pathlib import Path

import numpy as np
import pytest

from protocol.limits import MAX_CELLS
from solver_service.errors import TerrainError
from solver_service.terrain.read_npz import read_npz

BED = np.array([[1.0, 2.0, np.nan], [4.0, 5.0, 6.0]], np.float32)


@pytest.fixture
def archive(tmp_path: Path) -> Path:
    path = tmp_path / "bed.npz"
    np.savez(path, bed=BED, dx=2.0, x0=10.0, y0=20.0, names=np.array(["a"]))
    return path


def test_row_0_is_south_unless_said_otherwise(archive: Path) -> None:
    np.testing.assert_array_equal(read_npz(archive, "bed", "south", None).values, BED)
    np.testing.assert_array_equal(read_npz(archive, "bed", "north", None).values, BED[::-1])


def test_position_and_cell_size_of_the_archive_win(archive: Path) -> None:
    assert read_npz(archive, "bed", "south", 99.0, (0.0, 0.0)).bounds == (10.0, 20.0, 16.0, 24.0)


def test_an_array_of_decimetre_differences_is_undone(tmp_path: Path) -> None:
    decimetres = np.array([[3000, 3010, 2990], [3005, -32768, 2950]], np.int16)
    stored = np.diff(np.diff(decimetres, axis=0, prepend=np.int16(0)), axis=1, prepend=np.int16(0))
    np.savez(tmp_path / "bed.npz", bed=stored, bed_differences=np.int8(1), bed_scale=0.1, dx=30.0)

    raster = read_npz(tmp_path / "bed.npz", "bed", "south", None)

    np.testing.assert_allclose(raster.values, [[300.0, 301.0, 299.0], [300.5, np.nan, 295.0]])


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("bad", "no array 'bad'; it has bed, dx, names, x0, y0"),
        ("names", "numbers are allowed"),
        ("dx", "0 dimensions"),
    ],
)
def test_an_array_that_is_no_raster_is_refused(archive: Path, key: str, message: str) -> None:
    with pytest.raises(TerrainError, match=message):
        read_npz(archive, key, "south", None)


def test_a_missing_cell_size_is_asked_for(tmp_path: Path) -> None:
    np.savez(tmp_path / "bed.npz", bed=BED)

    with pytest.raises(TerrainError, match=r"\[terrain\] cell_size in m is needed"):
        read_npz(tmp_path / "bed.npz", "bed", "south", None)
    assert read_npz(tmp_path / "bed.npz", "bed", "south", 5.0, (1.0, 2.0)).bounds == (1.0, 2.0, 16.0, 12.0)


def test_pickled_objects_are_never_loaded(tmp_path: Path) -> None:
    np.savez(tmp_path / "bed.npz", bed=np.array([[{"an": "object"}]], dtype=object), dx=1.0)

    with pytest.raises(TerrainError, match="cannot be read as a NumPy archive"):
        read_npz(tmp_path / "bed.npz", "bed", "south", None)


def test_an_array_that_says_it_is_huge_is_refused_unread(tmp_path: Path) -> None:
    path = tmp_path / "bed.npz"
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open("bed.npy", "w", force_zip64=True) as entry,
    ):
        for _ in range(8 * MAX_CELLS // (1 << 24) + 2):
            entry.write(bytes(1 << 24))

    with pytest.raises(TerrainError, match=f"larger than {MAX_CELLS} cells"):
        read_npz(path, "bed", "south", None)


def test_a_file_that_is_no_archive_is_refused(tmp_path: Path) -> None:
    (tmp_path / "bed.npz").write_bytes(b"PK nonsense")

    with pytest.raises(TerrainError, match=r"'bed.npz' cannot be read as a NumPy archive"):
        read_npz(tmp_path / "bed.npz", "bed", "south", None)
