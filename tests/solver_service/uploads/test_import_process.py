"""What the import says of cases that are wrong or made to harm, and what it leaves."""

import struct
from pathlib import Path

import numpy as np
import pytest
import rasterio

from solver_service.errors import ServiceError
from solver_service.uploads.import_messages import Accepted, ImportLimits, ImportMessage, Stage
from solver_service.uploads.import_process import import_archive
from tests.solver_service.scenario import hostile_zips
from tests.solver_service.tiny_case import CASE, valley
from tests.solver_service.uploads.archives import packed, tiny

LIMITS = ImportLimits(cells=5000, unpacked_bytes=50_000_000, probe_s=0.05)


def imported(folder: Path, archive: bytes) -> tuple[Accepted, list[ImportMessage]]:
    """Import an archive within this process, which is not confined."""
    folder.mkdir(exist_ok=True)
    (folder / "archive.zip").write_bytes(archive)
    said: list[ImportMessage] = []
    return import_archive(folder, LIMITS, said.append), said


def case_with(**files: bytes) -> bytes:
    """The tiny case whose terrain is another file: bed_tif stands for bed.tif."""
    name, data = next(iter(files.items()))
    file = name.replace("_", ".")
    text = CASE.replace('dem = "bed.npz"\nkey = "bed"', f'dem = "{file}"')
    return packed({"case.toml": text.encode(), file: data})


def test_a_good_case_is_accepted_and_left_whole(tmp_path: Path) -> None:
    found, said = imported(tmp_path / "u", tiny(tmp_path))

    assert found.summary.name == "tiny"
    assert (found.summary.nrows, found.summary.ncols) == valley().shape
    assert [message.stage for message in said if isinstance(message, Stage)][-2:] == ["reading", "trying"]
    left = tmp_path / "u" / "shelf" / "case"
    assert sorted(path.name for path in left.iterdir()) == ["bed.npz", "case.toml"]


def test_a_case_in_a_folder_of_its_archive_is_accepted(tmp_path: Path) -> None:
    archive = packed(
        {
            "valley/case.toml": CASE.encode(),
            "valley/bed.npz": _npz(bed=valley(), dx=np.array(10.0), x0=np.array(1000.0), y0=np.array(2000.0)),
        }
    )

    assert imported(tmp_path / "u", archive)[0].summary.name == "tiny"


@pytest.mark.parametrize(
    ("archive", "sentence"),
    [
        (lambda _: packed({"readme.txt": b"hello"}), "the archive: holds no case.toml"),
        (lambda _: packed({"case.toml": b"x = [" * 50_000}), "case.toml: is no valid TOML"),
        (
            lambda _: packed({"case.toml": b"#" + bytes(range(35, 127)) * 50_000}),
            "case.toml: is larger than 4194304 bytes",
        ),
        (lambda _: packed({"case.toml": b"\0\0"}), "case.toml: does not begin like a text"),
        (lambda _: packed({"case.toml": CASE.encode()}), r"\[terrain\] dem.*'bed.npz', which does not exist"),
        (
            lambda _: packed({"case.toml": CASE.replace("bed.npz", "../../../etc/passwd").encode()}),
            "a relative path within the folder of the case is allowed",
        ),
        (
            lambda _: packed({"case.toml": CASE.replace("bed.npz", "/etc/passwd").encode()}),
            "a relative path within the folder of the case is allowed",
        ),
        (
            lambda _: packed({"case.toml": CASE.replace("bed.npz", "/vsicurl/http://x/a.tif").encode()}),
            "a relative path within the folder of the case is allowed",
        ),
        (lambda tmp: tiny(tmp, bed=np.full((24, 40), np.nan, np.float32)), "bed.npz|no data|no cell"),
        (lambda tmp: tiny(tmp, bed=np.zeros((100, 100), np.float32)), "10000 cells; up to 5000 are allowed"),
        (lambda tmp: tiny(tmp, text=CASE.replace('"tiny"', '"../x"')), "letters, digits, '_' and '-'"),
        (lambda tmp: tiny(tmp, text=CASE.replace("20.0", "nan")), "duration"),
        (lambda _: case_with(bed_vrt=b"<VRTDataset/>"), "bed.vrt: is of no kind that a case may hold"),
        (lambda _: case_with(bed_tif=b"<VRTDataset/>"), "bed.tif: does not begin like a TIFF"),
        (lambda _: case_with(bed_tif=b"II*\0" + bytes(range(200))), "bed.tif"),
        (lambda _: case_with(bed_tif=_absurd_tiff()), r"bed.tif.*(cells are allowed|cannot be read)"),
        (lambda _: case_with(bed_asc=b"ncols 9999999\nnrows 9999999\ncellsize 1\n1 2 3"), "bed.asc.*allowed"),
        (lambda _: packed({"case.toml": CASE.encode(), "bed.npz": _swollen_npz()}), "bed.npz"),
        (lambda _: packed({"case.toml": CASE.encode(), "bed.npz": b"PK\3\4 and no more"}), "bed.npz"),
        (lambda _: packed({"case.toml": CASE.encode(), "bed.npz": _npz(bed=np.array([{}]))}), "bed.npz"),
        (lambda tmp: hostile_zips.quine(tmp / "q.zip").read_bytes(), "holds no case.toml"),
        (lambda tmp: hostile_zips.overlapping(tmp / "o.zip").read_bytes(), "overlaps"),
        (lambda tmp: hostile_zips.million_entries(tmp / "m.zip").read_bytes(), "directory of 47000000 bytes"),
    ],
)
def test_a_case_that_is_wrong_is_refused_in_a_sentence_without_the_places_of_the_machine(
    tmp_path: Path, archive, sentence: str
) -> None:
    with pytest.raises(ServiceError, match=f"(?s){sentence}") as refusal:
        imported(tmp_path / "u", archive(tmp_path))
    assert "\n" not in str(refusal.value).strip()
    assert sum(path.stat().st_size for path in tmp_path.rglob("*")) < 120_000_000


def _npz(**arrays: np.ndarray) -> bytes:
    import io

    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


def _swollen_npz() -> bytes:
    """An array that says it has 10^12 cells."""
    head = "{'descr': '<f4', 'fortran_order': False, 'shape': (1000000, 1000000), }"
    head = head.ljust(117) + "\n"
    return packed({"bed.npy": b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode()})


def _absurd_tiff() -> bytes:
    """A GeoTIFF of 40 000 x 40 000 cells in a few kilobytes."""
    with rasterio.MemoryFile() as file:
        options = {"width": 40_000, "height": 40_000, "count": 1, "dtype": "float32", "SPARSE_OK": True}
        transform = rasterio.transform.from_origin(1000.0, 2000.0, 2.0, 2.0)
        with file.open(
            driver="GTiff", transform=transform, tiled=True, blockxsize=4096, blockysize=4096, **options
        ):
            pass
        return bytes(file.getbuffer())
