"""What a file of an uploaded case may be: its suffix says the kind, and its first bytes must agree.

So that each file reaches the one reader that its kind has, and nothing reaches a reader that reads other
files (a VRT names files, a netCDF name may be an address).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from solver_service.errors import CaseError

HEAD_BYTES = 4096


@dataclass(frozen=True)
class FileKind:
    """One kind of file.

    Attributes:
        name: for people.
        suffixes: endings of its names, in lower case.
        beginnings: what its first bytes are, one of these; () for text.
    """

    name: str
    suffixes: tuple[str, ...]
    beginnings: tuple[bytes, ...] = ()

    def fits(self, head: bytes) -> bool:
        """Whether a file that begins so is of this kind."""
        if self.beginnings:
            return head.startswith(self.beginnings)
        return b"\0" not in head and not head.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


KINDS = (
    FileKind("a text", (".toml", ".csv", ".asc", ".dem", ".geojson", ".json", ".prj", ".txt", ".md")),
    FileKind("a TIFF", (".tif", ".tiff"), (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")),
    FileKind("an ERDAS Imagine raster", (".img",), (b"EHFA_HEADER_TAG",)),
    FileKind("an archive of arrays or of an SRTM tile", (".npz", ".hgt.zip"), (b"PK\3\4",)),
    FileKind("a SELAFIN mesh", (".slf",), (b"\0\0\0\x50",)),
    FileKind("a gzipped SELAFIN mesh", (".slf.gz",), (b"\x1f\x8b",)),
    FileKind("a PNG picture", (".png",), (b"\x89PNG\r\n\x1a\n",)),
    FileKind("a JPEG picture", (".jpg", ".jpeg"), (b"\xff\xd8\xff",)),
)
TILE_SUFFIX = ".hgt"
"""An SRTM tile has no beginning of its own; its size is checked by its reader."""
SUFFIXES = tuple(sorted({suffix for kind in KINDS for suffix in kind.suffixes} | {TILE_SUFFIX}))


def kind_of(name: str) -> FileKind | None:
    """The kind that a name says; None for none, and for an SRTM tile."""
    lower = name.lower()
    return next((kind for kind in KINDS if lower.endswith(kind.suffixes)), None)


def is_allowed(name: str) -> bool:
    """Whether a case may hold a file of this name."""
    return name.lower().endswith(SUFFIXES)


def check_files(root: Path) -> None:
    """Look at every file below a folder.

    Raises:
        CaseError: one is of no kind that a case may hold, or is not what its name says.
    """
    for path in sorted(root.rglob("*")):
        if path.is_symlink() or not (path.is_file() or path.is_dir()):
            raise CaseError(f"{path.relative_to(root)}: is a link or device; plain files are allowed.")
        if path.is_dir():
            continue
        name = path.relative_to(root).as_posix()
        if not is_allowed(name):
            raise CaseError(f"{name}: is of no kind that a case may hold; {', '.join(SUFFIXES)} are allowed.")
        kind = kind_of(name)
        if kind is None:
            continue
        with path.open("rb") as file:
            head = file.read(HEAD_BYTES)
        if not kind.fits(head):
            raise CaseError(f"{name}: does not begin like {kind.name}; what its name says is allowed.")
