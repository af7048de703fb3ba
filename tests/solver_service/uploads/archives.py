"""Archives of cases for the tests of uploads."""

import io
import zipfile
from pathlib import Path

import numpy as np

from tests.solver_service.tiny_case import CASE, valley, write_case


def packed(entries: dict[str, bytes]) -> bytes:
    """A zip of these entries."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)
    return file.getvalue()


def packed_folder(folder: Path) -> bytes:
    """A zip of the files of a folder."""
    files = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return packed({path.relative_to(folder).as_posix(): path.read_bytes() for path in files})


def tiny(tmp_path: Path, name: str = "tiny", text: str = CASE, bed: np.ndarray | None = None) -> bytes:
    """The archive of the tiny case, with another name, text or bed."""
    folder = tmp_path / f"made-{name}"
    write_case(folder, text.replace('name = "tiny"', f'name = "{name}"'), valley() if bed is None else bed)
    return packed_folder(folder)
