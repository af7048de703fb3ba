from pathlib import Path

import numpy as np
import pytest
import zstandard

from solver_service.errors import StoreError
from solver_service.store import DataFolder
from solver_service.store.terrain_files import load_bed, load_layer, save_bed, save_layer


def test_a_bed_comes_back_bit_for_bit(tmp_path: Path, rng: np.random.Generator) -> None:
    folder, z_b = DataFolder(tmp_path), rng.normal(100.0, 30.0, (7, 9)).astype(np.float32)
    save_bed(folder, "bed", z_b)

    stored = zstandard.ZstdDecompressor().decompress(load_bed(folder, "bed"), max_output_size=z_b.nbytes)

    assert stored == z_b.tobytes()


def test_a_bed_that_is_there_is_not_written_again(tmp_path: Path) -> None:
    folder, z_b = DataFolder(tmp_path), np.zeros((3, 3), np.float32)
    path = save_bed(folder, "bed", z_b)
    before = path.stat().st_mtime_ns

    assert save_bed(folder, "bed", z_b) == path
    assert path.stat().st_mtime_ns == before


def test_a_bed_that_cannot_be_written_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = DataFolder(tmp_path)

    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("solver_service.store.terrain_files.os.fsync", full)

    with pytest.raises(StoreError, match="cannot be written: No space left on device"):
        save_bed(folder, "bed", np.zeros((3, 3), np.float32))
    assert list((tmp_path / "terrain").iterdir()) == []


def test_a_bed_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match=r"nothing\.zst cannot be read"):
        load_bed(DataFolder(tmp_path), "nothing")


def test_a_picture_is_kept_beside_its_bed_and_replaced_whole(tmp_path: Path) -> None:
    folder = DataFolder(tmp_path)
    save_layer(folder, "f00d", "imagery", b"old")
    save_layer(folder, "f00d", "imagery", b"new")
    save_layer(folder, "f00d", "walls", b"mask")

    assert load_layer(folder, "f00d", "imagery") == b"new"
    assert load_layer(folder, "f00d", "walls") == b"mask"
    assert len(list(folder.terrain("f00d").parent.iterdir())) == 2
    with pytest.raises(StoreError, match="cannot be read"):
        load_layer(folder, "beef", "walls")
