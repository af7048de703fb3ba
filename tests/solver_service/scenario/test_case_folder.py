import os
import zipfile
from pathlib import Path

import pytest

from solver_service.errors import CaseError
from solver_service.scenario.case_folder import CaseFolder, open_case


@pytest.fixture
def folder(tmp_path: Path) -> CaseFolder:
    root = tmp_path / "case"
    (root / "maps").mkdir(parents=True)
    (root / "maps" / "bed.tif").write_bytes(b"II*")
    (root / "case.toml").write_text("")
    (tmp_path / "secret.tif").write_bytes(b"II*")
    return CaseFolder(root / "case.toml", root)


def test_a_file_within_the_folder_is_found(folder: CaseFolder) -> None:
    assert folder.find("maps/bed.tif", "dem").read_bytes() == b"II*"


@pytest.mark.parametrize(
    "name",
    [
        "../secret.tif",
        "maps/../../secret.tif",
        "/etc/passwd",
        "C:/secret.tif",
        "..\\secret.tif",
        "",
        "a\0b",
        "file:///etc/passwd",
    ],
)
def test_a_path_out_of_the_folder_is_refused(folder: CaseFolder, name: str) -> None:
    with pytest.raises(CaseError, match=r"case.toml: \[terrain\] dem is .*relative path within the folder"):
        folder.find(name, "case.toml: [terrain] dem")


def test_a_link_out_of_the_folder_is_refused(folder: CaseFolder) -> None:
    os.symlink(folder.root.parent / "secret.tif", folder.root / "bed.tif")
    os.symlink(folder.root.parent, folder.root / "up")

    for name in ("bed.tif", "up/secret.tif"):
        with pytest.raises(CaseError, match="a link out of the folder"):
            folder.find(name, "dem")


def test_a_missing_file_is_named(folder: CaseFolder) -> None:
    with pytest.raises(CaseError, match=r"dem is 'none.tif', which does not exist"):
        folder.find("none.tif", "dem")


def archive(path: Path, entries: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as target:
        for name, data in entries.items():
            target.writestr(name, data)
    return path


@pytest.mark.parametrize("prefix", ["", "valley/"])
def test_an_archive_is_unpacked_for_the_time_of_the_block(tmp_path: Path, prefix: str) -> None:
    path = archive(tmp_path / "a.fevcase", {f"{prefix}case.toml": b"x = 1", f"{prefix}maps/bed.tif": b"II*"})

    with open_case(path) as folder:
        assert folder.text() == "x = 1"
        assert folder.find("maps/bed.tif", "dem").is_file()
        assert folder.temporary
        root = folder.root

    assert not root.exists()


@pytest.mark.parametrize(
    "name", ["../evil.txt", "/evil.txt", "a/../../evil.txt", "..\\evil.txt", "C:evil.txt"]
)
def test_an_archive_that_writes_outside_is_refused(tmp_path: Path, name: str) -> None:
    path = archive(tmp_path / "a.fevcase", {"case.toml": b"", name: b"evil"})

    with pytest.raises(CaseError, match="a path that leaves the archive"), open_case(path):
        pass
    assert not list(tmp_path.rglob("*evil*"))


def test_a_link_in_an_archive_is_refused(tmp_path: Path) -> None:
    link = zipfile.ZipInfo("bed.tif")
    link.external_attr = 0o120777 << 16
    with zipfile.ZipFile(tmp_path / "a.fevcase", "w") as target:
        target.writestr("case.toml", "")
        target.writestr(link, "/etc/passwd")

    with pytest.raises(CaseError, match=r"the link or device 'bed.tif'"), open_case(tmp_path / "a.fevcase"):
        pass


def test_a_file_that_would_swell_is_refused(tmp_path: Path) -> None:
    path = archive(tmp_path / "a.fevcase", {"case.toml": b"", "bed.npz": bytes(40_000_000)})

    with pytest.raises(CaseError, match=r"'bed.npz' unpacks to 40000000 bytes"), open_case(path):
        pass


def test_a_torn_archive_and_one_without_a_case_are_refused(tmp_path: Path) -> None:
    whole = archive(tmp_path / "a.fevcase", {"readme.txt": b"hello" * 100})
    (tmp_path / "torn.fevcase").write_bytes(whole.read_bytes()[:60])

    with pytest.raises(CaseError, match=r"holds no case.toml"), open_case(whole):
        pass
    with pytest.raises(CaseError, match="its end is missing"), open_case(tmp_path / "torn.fevcase"):
        pass


def test_what_is_no_case_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("")

    with (
        pytest.raises(CaseError, match=r"is no case; a folder with a case.toml"),
        open_case(tmp_path / "a.txt"),
    ):
        pass
    with pytest.raises(CaseError, match="no such case file"), open_case(tmp_path):
        pass


def test_a_case_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_bytes(b"\xff\xfe\x00")

    with open_case(tmp_path) as folder, pytest.raises(CaseError, match="cannot be read"):
        folder.text()
