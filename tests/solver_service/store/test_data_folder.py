import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import zstandard

from solver_service.errors import StoreError
from solver_service.store import DataFolder, load_bed, save_bed

_HOLDER = """
import sys
from pathlib import Path
from solver_service.store import DataFolder
folder = DataFolder(Path(sys.argv[1]))
folder.lock()
print("held", flush=True)
sys.stdin.read()
"""


def test_a_second_service_on_the_folder_is_refused_until_the_first_is_dead(tmp_path: Path) -> None:
    command = [sys.executable, "-c", _HOLDER, str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(StoreError, match=f"in use by another service \\(process {holder.pid}\\)"):
            DataFolder(tmp_path).lock()
        holder.kill()
    with DataFolder(tmp_path):
        pass


@pytest.mark.parametrize("name", ["..", "a/b", "", "x" * 65, "a\n", "r1.segment"])
def test_an_id_that_could_be_a_path_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(StoreError, match="letters, digits"):
        DataFolder(tmp_path).frames(name)


def test_a_folder_that_cannot_be_made_is_told_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match="cannot be used"):
        DataFolder(tmp_path / "file")


def test_a_folder_in_which_no_lock_can_be_made_is_told_in_a_sentence(tmp_path: Path) -> None:
    folder = DataFolder(tmp_path / "data")
    (folder.root / "service.lock").mkdir()
    with pytest.raises(StoreError, match="data cannot be used: Is a directory"):
        folder.lock()


def test_a_bed_is_kept_without_loss(tmp_path: Path, rng: np.random.Generator) -> None:
    folder = DataFolder(tmp_path)
    z_b = rng.random((20, 30)).astype(np.float32)
    save_bed(folder, "f00d", z_b)
    raw = zstandard.ZstdDecompressor().decompress(load_bed(folder, "f00d"))
    assert raw == z_b.tobytes()
    with pytest.raises(StoreError, match="cannot be read"):
        load_bed(folder, "beef")
