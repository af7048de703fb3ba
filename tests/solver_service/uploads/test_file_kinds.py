import os
from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.uploads.file_kinds import check_files, is_allowed, kind_of

VRT = b'<VRTDataset rasterXSize="1" rasterYSize="1"><SourceFilename>/etc/passwd</SourceFilename></VRTDataset>'


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("case.toml", b"[case]"),
        ("maps/bed.tif", b"II*\0rest"),
        ("bed.tiff", b"MM\0*rest"),
        ("bed.asc", b"ncols 3"),
        ("N49E011.hgt", bytes(100)),
        ("N49E011.hgt.zip", b"PK\3\4"),
        ("bed.npz", b"PK\3\4"),
        ("mesh.slf", b"\0\0\0\x50mesh"),
        ("mesh.slf.gz", b"\x1f\x8b\x08"),
        ("bed.img", b"EHFA_HEADER_TAG\0"),
        ("ortho.png", b"\x89PNG\r\n\x1a\n"),
        ("q.csv", b"\xef\xbb\xbftime_s,q"),
    ],
)
def test_a_file_that_is_what_its_name_says_is_taken(tmp_path: Path, name: str, data: bytes) -> None:
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_bytes(data)
    check_files(tmp_path)


@pytest.mark.parametrize(
    ("name", "data", "sentence"),
    [
        ("bed.vrt", VRT, "bed.vrt: is of no kind that a case may hold"),
        ("bed.tif", VRT, "bed.tif: does not begin like a TIFF"),
        ("bed.asc", VRT, "bed.asc: does not begin like a text"),
        ("bed.dem", b"\n " + VRT, "bed.dem: does not begin like a text"),
        ("bed.asc", b"II*\0", "does not begin like a text"),
        ("bed.npz", b"\x89HDF", "does not begin like an archive of arrays"),
        ("bed.nc", b"CDF\1", "is of no kind"),
        ("bed.mrf", b"<MRF_META>", "is of no kind"),
        ("inner.zip", b"PK\3\4", "is of no kind"),
        ("run.py", b"import os", "is of no kind"),
        ("noname", b"", "is of no kind"),
    ],
)
def test_a_file_that_is_something_else_is_refused(
    tmp_path: Path, name: str, data: bytes, sentence: str
) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(CaseError, match=sentence):
        check_files(tmp_path)


def test_links_and_devices_are_refused(tmp_path: Path) -> None:
    os.symlink("/etc/passwd", tmp_path / "bed.csv")
    with pytest.raises(CaseError, match=r"bed.csv: is a link or device"):
        check_files(tmp_path)
    (tmp_path / "bed.csv").unlink()
    os.mkfifo(tmp_path / "bed.csv")
    with pytest.raises(CaseError, match=r"bed.csv: is a link or device"):
        check_files(tmp_path)


def test_every_terrain_format_of_the_solver_may_be_uploaded() -> None:
    from solver_service.terrain.read_dem import FORMATS

    assert all(is_allowed(f"N49E011{suffix}") for suffix in FORMATS)
    assert kind_of("a.SLF.GZ") is not kind_of("a.slf")
